// SPDX-License-Identifier: MIT
// --jobs: several inputs at once, each in a worker thread with a module of its own. Reading, writing and printing stay
// on the main thread, results come in the order of the inputs.
import { availableParallelism } from 'node:os';
import { Worker } from 'node:worker_threads';
import { QuadmarkError } from '../error.js';
import { embed, extract, inspect } from '../index_node.js';

class Pool {
  #idle = [];
  #all = [];

  /** An idle worker or a new one: callers see to it that there are not too many calls at once. */
  #worker() {
    if (this.#idle.length > 0) return this.#idle.pop();
    const worker = new Worker(new URL('./worker.js', import.meta.url));
    this.#all.push(worker);
    return worker;
  }

  /** Functions stay here: a thread reports progress by messages. */
  async call(name, model, { options = {}, ...request }) {
    const worker = this.#worker();
    const { onProgress, ...plain } = options;
    let settle;
    const reply = await new Promise((resolve) => {
      const broken = (error) => resolve({ error: { code: 'internal', message: `a worker ended: ${error?.message ?? error}` }, broken: true });
      const message = (reply) => (reply.progress ? onProgress(reply.progress) : resolve(reply));
      settle = { message, error: broken, exit: broken };
      for (const [event, listener] of Object.entries(settle)) worker.on(event, listener);
      worker.postMessage({ name, model, request: name === 'inspect' ? request : { ...request, options: plain }, reports: onProgress !== undefined });
    });
    // Only ours: a worker has listeners of its own.
    for (const [event, listener] of Object.entries(settle)) worker.off(event, listener);
    if (reply.broken) this.#all.splice(this.#all.indexOf(worker), 1);
    else this.#idle.push(worker);
    if (reply.error) throw new QuadmarkError(reply.error.code, reply.error.message);
    return reply.result;
  }

  async close() {
    await Promise.all(this.#all.map((worker) => worker.terminate()));
  }
}

/** How many jobs a run gets: --jobs, 0 meaning one per processor, never more than inputs. */
export function jobCount(wanted, inputs) {
  return Math.max(1, Math.min(wanted === 0 ? availableParallelism() : wanted, inputs));
}

/**
 * Handles inputs, up to `jobs` at once.
 * @param handle  (input, calls) => function that prints its result and returns its exit status; may throw
 * @param fail    (input, error) => exit status
 * @param threads  whether the calls go to worker threads; one input may then make several at once
 * @return the exit statuses in the order of the inputs
 */
export async function forEachInput(inputs, jobs, handle, fail, { threads = jobs > 1 } = {}) {
  const pool = threads ? new Pool() : null;
  const calls = pool
    ? Object.fromEntries(['embed', 'extract', 'inspect'].map((name) => [name, (model, request) => pool.call(name, model, request)]))
    : { embed, extract, inspect };
  const outcomes = new Map();
  const statuses = [];
  let next = 0;
  const flush = () => {
    while (outcomes.has(statuses.length)) {
      const input = inputs[statuses.length];
      const outcome = outcomes.get(statuses.length);
      outcomes.delete(statuses.length);
      statuses.push('error' in outcome ? fail(input, outcome.error) : outcome.finish());
    }
  };
  const lane = async () => {
    while (next < inputs.length) {
      const index = next++;
      try {
        outcomes.set(index, { finish: await handle(inputs[index], calls) });
      } catch (error) {
        outcomes.set(index, { error });
      }
      flush();
    }
  };
  try {
    await Promise.all(Array.from({ length: jobs }, lane));
  } finally {
    await pool?.close();
  }
  return statuses;
}
