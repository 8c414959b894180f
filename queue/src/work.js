// SPDX-License-Identifier: MIT
// A worker: takes models from the queue, each in a process of its own, and writes reports.
import { Queue, UnrecoverableError, Worker } from 'bullmq';
import { QuadmarkError } from 'quadmark';
import { reportQueue } from './connection.js';
import { checkRoots } from './files.js';
import { createReporter } from './report.js';
import { Sandbox } from './sandbox.js';

/** Seconds that a worker which was killed keeps others from its jobs. */
export const LOCK_SECONDS = 30;

/** Seconds for one model. */
export const TIME_LIMIT_SECONDS = 600;

/**
 * Times that a job may lose its worker. Machines fail without a model being the cause, but a model that takes its worker
 * along each time must end as a dead letter.
 */
const MAX_LOST = 10;

/**
 * Starts a worker. Documented in index.d.ts.
 * @param onDone  called with { input, output, error? } after each model
 */
export async function startWorker(redis, request) {
  const { queue, inRoot, outRoot, keys, concurrency = 1, onDone = () => {} } = request;
  const { lockSeconds = LOCK_SECONDS, timeLimit = TIME_LIMIT_SECONDS } = request;
  checkRoots(inRoot, outRoot);
  if (!(Number.isInteger(concurrency) && concurrency >= 1)) {
    throw new QuadmarkError('bad_option', 'concurrency: expected a whole number from 1');
  }
  const timing = { lockDuration: lockSeconds * 1000, stalledInterval: lockSeconds * 500, maxStalledCount: MAX_LOST };
  const sandbox = new Sandbox({ ...process.env, QUADMARK_QUEUE_WORKER: JSON.stringify({ inRoot, outRoot, keys }) }, timeLimit);
  const mark = async (job) => {
    const { id, data } = job;
    const { result, error } = await sandbox.run({ id, data }, (progress) => { job.updateProgress(progress).catch(() => {}); });
    if (error) throw error.final ? new UnrecoverableError(error.told) : new Error(error.told);
    return result;
  };
  const marker = new Worker(queue, mark, { connection: redis, concurrency, ...timing });
  const models = new Queue(queue, { connection: redis });
  const reporter = new Worker(reportQueue(queue), createReporter(models, outRoot), { connection: redis, ...timing });
  for (const worker of [marker, reporter]) worker.on('error', () => {});  // of the connection, which is tried again
  marker.on('completed', ({ data }) => onDone({ input: data.input, output: data.output }));
  marker.on('failed', (job, error) => {
    if (job) onDone({ input: job.data.input, output: job.data.output, error: error.message });
  });
  await Promise.all([marker.waitUntilReady(), reporter.waitUntilReady()]);
  return {
    /** Finishes the models it is at, takes no others. */
    async close() {
      await Promise.all([marker.close(), reporter.close()]);
      await Promise.all([models.close(), sandbox.close()]);
    },
  };
}
