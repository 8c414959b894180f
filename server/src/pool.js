// SPDX-License-Identifier: MIT
// The threads that do the work. Aborting a call ends its thread, in the middle of wasm code too, and another takes its
// place: a time limit that only stopped waiting would leave the processor to whoever sends slow models.
import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { Piscina } from 'piscina';
import { QuadmarkError } from 'quadmark';

/** A thread gives back its module's memory after a model that took more than this; wasm memory never shrinks. */
const KEEP_BYTES = 256 * 2 ** 20;

async function compileModule(name) {
  return WebAssembly.compile(await readFile(fileURLToPath(import.meta.resolve(`quadmark/${name}.wasm`))));
}

export class Pool {
  #piscina;
  #ended = 0;
  #calls = 0;

  /** Compiles the modules once, for all threads. */
  static async create(threads) {
    const [wasm, dracoWasm] = await Promise.all(['quadmark', 'quadmark_draco'].map(compileModule));
    return new Pool(new Piscina({
      filename: new URL('./worker.js', import.meta.url).href,
      minThreads: threads,
      maxThreads: threads,
      workerData: { wasm, dracoWasm, keepBytes: KEEP_BYTES },
    }));
  }

  constructor(piscina) {
    this.#piscina = piscina;
    piscina.on('workerDestroy', () => { ++this.#ended; });
    // A thread that dies idle is replaced; one that dies at work rejects its call.
    piscina.on('error', () => {});
  }

  /**
   * Runs a call of the library in a thread.
   * @param name    embed or extract
   * @param model   bytes that own their buffer: they are moved to the thread, not copied
   * @param signal  aborting it ends the thread
   */
  async run(name, model, request, signal) {
    let reply;
    ++this.#calls;
    try {
      reply = await this.#piscina.run({ name, model, request }, { signal, transferList: [model.buffer] });
    } catch (error) {
      signal.throwIfAborted();
      throw new QuadmarkError('internal', `a worker thread ended: ${error.message}`, { cause: error });
    } finally {
      --this.#calls;
    }
    if (reply.error) throw new QuadmarkError(reply.error.code, reply.error.message);
    return reply.result;
  }

  /** Threads that were ended before the pool itself was. */
  get ended() {
    return this.#ended;
  }

  get waiting() {
    return this.#piscina.queueSize;
  }

  get working() {
    return this.#calls - this.waiting;
  }

  async close() {
    await this.#piscina.destroy();
  }
}
