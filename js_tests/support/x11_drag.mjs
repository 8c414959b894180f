// SPDX-License-Identifier: MIT
// Drags files of the disk over a window of an X screen and drops them, as a file manager does: the source's side of the
// XDND protocol, version 5 (freedesktop.org), spoken to the X server directly. WebDriver cannot carry files into a drag.
import { createConnection } from 'node:net';
import { pathToFileURL } from 'node:url';

const OPCODES = { createWindow: 1, getGeometry: 14, queryTree: 15, internAtom: 16, changeProperty: 18, getProperty: 20, setSelectionOwner: 22, sendEvent: 25 };
const SELECTION_REQUEST = 30, SELECTION_NOTIFY = 31, CLIENT_MESSAGE = 33;
const ATOM = 4;          // the predefined type "ATOM"
const VERSION = 5 << 24;
const PATIENCE = 20000;  // milliseconds until a window that does not answer is given up

const words = (...values) => {
  const bytes = Buffer.alloc(4 * values.length);
  values.forEach((value, i) => bytes.writeUInt32LE(value >>> 0, 4 * i));
  return bytes;
};
const padded = (bytes) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4)]);

/** A connection to an X server: requests, their replies in order, and events. */
class Server {
  #socket;
  #received = Buffer.alloc(0);
  #replies = [];
  #nextId;
  #isOpen = false;
  onEvent = () => {};

  static async open(display) {
    const server = new Server();
    server.#socket = createConnection(`/tmp/.X11-unix/X${display.slice(1)}`);
    const setup = server.#expect();
    server.#socket.on('data', (bytes) => server.#take(bytes));
    server.#socket.on('error', (error) => server.#replies.splice(0).forEach(({ reject }) => reject(error)));
    server.#socket.write(Buffer.from([0x6c, 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0]));  // little-endian, protocol 11.0, no authorization
    const answer = await setup;
    server.#nextId = answer.readUInt32LE(12);
    const vendor = answer.readUInt16LE(24), formats = answer[29];
    server.root = answer.readUInt32LE(40 + vendor + ((4 - (vendor % 4)) % 4) + 8 * formats);
    return server;
  }

  #expect() {
    return new Promise((resolve, reject) => this.#replies.push({ resolve, reject }));
  }

  #take(bytes) {
    this.#received = Buffer.concat([this.#received, bytes]);
    for (;;) {
      const head = this.#received;
      if (head.length < (this.#isOpen ? 32 : 8)) return;
      const length = this.#isOpen ? 32 + (head[0] === 1 ? 4 * head.readUInt32LE(4) : 0) : 8 + 4 * head.readUInt16LE(6);
      if (head.length < length) return;
      this.#received = head.subarray(length);
      const message = head.subarray(0, length);
      if (message[0] === 1) {
        this.#isOpen = true;
        this.#replies.shift()?.resolve(message);
      } else if (message[0] === 0) {
        this.#replies.shift()?.reject(new Error(`the X server refuses: error ${message[1]}`));
      } else {
        this.onEvent(message);
      }
    }
  }

  send(name, detail, body) {
    const head = Buffer.from([OPCODES[name], detail, 0, 0]);
    head.writeUInt16LE(1 + body.length / 4, 2);
    this.#socket.write(Buffer.concat([head, body]));
  }

  ask(name, detail, body) {
    const reply = this.#expect();
    this.send(name, detail, body);
    return reply;
  }

  async atom(name) {
    const length = Buffer.alloc(4);
    length.writeUInt16LE(name.length);
    return (await this.ask('internAtom', 0, Buffer.concat([length, padded(Buffer.from(name))]))).readUInt32LE(8);
  }

  newWindow() {
    const id = this.#nextId++;
    this.send('createWindow', 0, words(id, this.root, 0, 0x10001, 0, 0, 0));  // one pixel, never shown
    return id;
  }

  setProperty(window, property, type, format, data) {
    this.send('changeProperty', 0, Buffer.concat([words(window, property, type, format, data.length / (format / 8)), padded(data)]));
  }

  sendEvent(window, event) {
    this.send('sendEvent', 0, Buffer.concat([words(window, 0), event]));
  }

  close() {
    this.#socket.destroy();
  }
}

/** The largest window that takes drops. */
async function findTarget(server, aware) {
  let best = null, largest = 0;
  const waiting = [server.root];
  while (waiting.length > 0) {
    const tree = await server.ask('queryTree', 0, words(waiting.pop()));
    for (let i = 0; i < tree.readUInt16LE(16); ++i) {
      const window = tree.readUInt32LE(32 + 4 * i);
      waiting.push(window);
      const property = await server.ask('getProperty', 0, words(window, aware, 0, 0, 1));
      if (property.readUInt32LE(8) === 0) continue;
      const geometry = await server.ask('getGeometry', 0, words(window));
      const area = geometry.readUInt16LE(16) * geometry.readUInt16LE(18);
      if (area > largest) [best, largest] = [window, area];
    }
  }
  if (best === null) throw new Error('no window takes drops');
  return best;
}

/**
 * @param display  of the X server, such as ":99"
 * @param paths    files and folders
 * @param x, y     on the screen
 * @param leave    whether they only hang over the window and go away again when `hanging` resolves
 */
export async function dragFiles(display, paths, { x, y, hanging = null }) {
  const server = await Server.open(display);
  try {
    const names = ['XdndAware', 'XdndSelection', 'XdndEnter', 'XdndPosition', 'XdndStatus', 'XdndLeave', 'XdndDrop', 'XdndFinished', 'XdndActionCopy', 'text/uri-list', 'TARGETS'];
    const atoms = Object.fromEntries(await Promise.all(names.map(async (name) => [name, await server.atom(name)])));
    const uris = Buffer.from(paths.map((path) => `${pathToFileURL(path).href}\r\n`).join(''));
    const target = await findTarget(server, atoms.XdndAware);
    const source = server.newWindow();
    const heard = { accepted: false, finished: false };

    server.onEvent = (event) => {
      const code = event[0] & 0x7f;
      if (code === CLIENT_MESSAGE) {
        const type = event.readUInt32LE(8);
        if (type === atoms.XdndStatus) heard.accepted = (event.readUInt32LE(16) & 1) === 1;
        if (type === atoms.XdndFinished) heard.finished = true;
      } else if (code === SELECTION_REQUEST) {
        const [time, , requestor, selection, wanted, property] = [4, 8, 12, 16, 20, 24].map((at) => event.readUInt32LE(at));
        if (wanted === atoms.TARGETS) server.setProperty(requestor, property, ATOM, 32, words(atoms['text/uri-list']));
        else server.setProperty(requestor, property, atoms['text/uri-list'], 8, uris);
        server.sendEvent(requestor, Buffer.concat([words(SELECTION_NOTIFY, time, requestor, selection, wanted, property), Buffer.alloc(8)]));
      }
    };
    const tell = (type, ...data) =>
      server.sendEvent(target, words(CLIENT_MESSAGE | 32 << 8, target, atoms[type], source, ...data, ...Array(4 - data.length).fill(0)));
    /** Moves the files about until the window has heard of them, and `done` says so. */
    const until = async (done, what, act = () => {}) => {
      for (const end = Date.now() + PATIENCE; !done();) {
        if (Date.now() > end) throw new Error(`dragging files: the window never ${what}`);
        act();
        await new Promise((resolve) => { setTimeout(resolve, 40); });
      }
    };

    server.send('setSelectionOwner', 0, words(source, atoms.XdndSelection, 0));
    tell('XdndEnter', VERSION, atoms['text/uri-list']);
    let step = 0;
    await until(() => heard.accepted, 'took the files', () => tell('XdndPosition', 0, ((x + step++ % 2) << 16) | y, 0, atoms.XdndActionCopy));
    if (hanging) {
      await hanging();
      tell('XdndLeave');
      await server.atom('TARGETS');  // a question, so that all before it has arrived
      return;
    }
    tell('XdndDrop', 0, 0);
    await until(() => heard.finished, 'finished the drop');
  } finally {
    server.close();
  }
}
