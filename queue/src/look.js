// SPDX-License-Identifier: MIT
// Looking at a queue: how far it is, which models could not be marked, and having those tried again.
import { Queue } from 'bullmq';
import { reportQueue } from './connection.js';
import { explain } from './report.js';

async function withQueues(redis, queue, use) {
  const models = new Queue(queue, { connection: redis });
  const reports = new Queue(reportQueue(queue), { connection: redis });
  try {
    return await use(models, reports);
  } finally {
    await Promise.all([models.close(), reports.close()]);
  }
}

/** { waiting, delayed, active, completed, failed, working: [{ input, progress }] } */
export const status = (redis, queue) => withQueues(redis, queue, async (models) => {
  const { waiting, delayed, active, completed, failed } =
    await models.getJobCounts('waiting', 'delayed', 'active', 'completed', 'failed');
  const working = (await models.getActive()).filter(Boolean).map(({ data, progress }) => ({ input: data.input, progress }));
  return { waiting, delayed, active, completed, failed, working };
});

/** How far a run is: { models, finished, reported, summary }; null for an unknown one. */
export const runStatus = (redis, queue, run) => withQueues(redis, queue, async (models, reports) => {
  const parent = await reports.getJob(run);
  if (!parent) return null;
  const state = await parent.getState();
  const { unprocessed = 0 } = await parent.getDependenciesCount({ unprocessed: true });
  const total = parent.data.jobs.length;
  return {
    models: total, finished: total - unprocessed, reported: state === 'completed', failed: state === 'failed' ? parent.failedReason : null,
    summary: parent.returnvalue ?? null,
  };
});

/** [{ job, input, output, error: { code, message }, attempts, when }] of the models that could not be marked. */
export const deadLetters = (redis, queue) => withQueues(redis, queue, async (models) =>
  (await models.getFailed()).filter(Boolean).map((job) => ({
    job: job.id, input: job.data.input, output: job.data.output, error: explain(job.failedReason), attempts: job.attemptsMade,
    when: new Date(job.finishedOn).toISOString(),
  })));

/**
 * Has dead letters tried again, and the reports of their runs written anew.
 * @param ids  of the jobs; all without
 * @return number of jobs
 */
export const retryDead = (redis, queue, ids) => withQueues(redis, queue, async (models, reports) => {
  const jobs = (await models.getFailed()).filter((job) => job && (!ids || ids.includes(job.id)));
  const runs = new Set();
  for (const job of jobs) {
    if (job.parent) runs.add(job.parent.id);
    await job.retry('failed', { resetAttemptsMade: true });
  }
  for (const run of runs) {
    const parent = await reports.getJob(run);
    if (parent && (await parent.isCompleted())) await parent.retry('completed');
  }
  return jobs.length;
});
