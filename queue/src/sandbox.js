// SPDX-License-Identifier: MIT
// Models are marked in processes of their own: one that takes its process along, or goes on for ever, leaves the worker
// alive to say so.
//
// Tried: BullMQ's own sandboxed processors. A process killed while it starts leaves its job locked for ever (its pool
// removes the listeners that it waits with), which the kill test ran into within a few runs; and they cannot be stopped.
import { fork } from 'node:child_process';
import { fileURLToPath } from 'node:url';

const PROCESSOR = fileURLToPath(new URL('./processor.js', import.meta.url));

const isAlive = (child) => child.exitCode === null && child.signalCode === null && child.connected;

export class Sandbox {
  #idle = [];
  #all = new Set();
  #env;
  #seconds;

  /**
   * @param env      of the processes
   * @param seconds  after which one is killed, and its model given up
   */
  constructor(env, seconds) {
    this.#env = env;
    this.#seconds = seconds;
  }

  #take() {
    while (this.#idle.length > 0) {
      const child = this.#idle.pop();
      if (isAlive(child)) return child;
    }
    const child = fork(PROCESSOR, [], { env: this.#env, stdio: ['ignore', 'ignore', 'inherit', 'ipc'] });
    this.#all.add(child);
    child.once('exit', () => this.#all.delete(child));
    child.on('error', () => {});  // while idle: 'exit' follows
    return child;
  }

  /**
   * Has a process mark one model.
   * @param job         { id, data }
   * @param onProgress  ({ stage, done })
   * @return { result } or { error: { told, final } }: final says that another try cannot succeed
   */
  async run(job, onProgress) {
    const child = this.#take();
    let timedOut = false;
    const heard = new Map();
    const hear = (event, listener) => {
      heard.set(event, listener);
      child.on(event, listener);
    };
    const timer = setTimeout(() => {
      timedOut = true;
      child.kill('SIGKILL');
    }, this.#seconds * 1000);
    try {
      const answer = await new Promise((resolve) => {
        const ended = (code, signal) => resolve(timedOut
          ? { error: { told: `aborted: stopped at the time limit of ${this.#seconds} s`, final: true } }
          : { error: { told: `internal: the process that marked it ended (${signal ?? `status ${code}`})`, final: false } });
        hear('message', (message) => (message.progress ? onProgress(message.progress) : resolve(message)));
        hear('exit', ended);
        hear('error', (error) => ended(error.message, null));
        child.send(job, () => {});  // one that cannot be sent to has ended, which is told above
      });
      return answer;
    } finally {
      clearTimeout(timer);
      for (const [event, listener] of heard) child.off(event, listener);
      if (isAlive(child)) this.#idle.push(child);
    }
  }

  /** Ends the processes; call it when none of them is at work. */
  async close() {
    await Promise.all([...this.#all].map((child) => new Promise((resolve) => {
      child.once('exit', resolve);
      child.kill('SIGKILL');
    })));
  }
}
