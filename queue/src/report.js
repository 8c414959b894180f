// SPDX-License-Identifier: MIT
// The job above the models of a run: writes what became of each when all are done.
import { DelayedError } from 'bullmq';
import { inside, removeParts, writeDurably } from './files.js';

const AGAIN_MILLIS = 1000;

/** { code, message } of a failed job's reason. */
export function explain(reason = '') {
  const [, code, message] = /^([a-z_]+): ([\s\S]*)$/.exec(reason) ?? [null, 'internal', reason];
  return { code, message };
}

async function describe(models, { id, input, output }) {
  const job = await models.getJob(id);
  if (!job) return { input, output, status: 'lost' };
  const state = await job.getState();
  const told = { input, output, job: id, attempts: job.attemptsMade };
  if (state === 'completed') return { ...told, status: 'marked', ...job.returnvalue };
  if (state === 'failed') return { ...told, status: 'failed', error: explain(job.failedReason) };
  return { ...told, status: 'unfinished' };
}

/**
 * Processor of report jobs.
 * @param models   queue of the models
 * @param outRoot  where the report goes, beside the marked models
 */
export const createReporter = (models, outRoot) => async (job, token) => {
  const { report, jobs, version, key, mark } = job.data;
  const items = [];
  for (const item of jobs) items.push(await describe(models, item));
  // Jobs of earlier runs are no children of this one, and those tried again no longer are.
  if (items.some(({ status }) => status === 'unfinished')) {
    await job.moveToDelayed(Date.now() + AGAIN_MILLIS, token);
    throw new DelayedError();
  }
  for (const { output, job: id } of items) if (id) await removeParts(inside(outRoot, output), id);
  const count = (wanted) => items.filter(({ status }) => status === wanted).length;
  const { image, ...payload } = mark;
  const summary = {
    run: job.id, version, key, mark: image ? { image: { width: image.width, height: image.height } } : payload,
    models: items.length, marked: count('marked'), failed: count('failed'), lost: count('lost'),
  };
  await writeDurably(inside(outRoot, report), JSON.stringify({ ...summary, results: items }, null, 2), job.id);
  return summary;
};
