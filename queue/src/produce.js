// SPDX-License-Identifier: MIT
// Queueing: a job per model, and above them one that writes the report when all are done. What was done before, or is
// under way, is not queued again.
import { stat } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { FlowProducer, Queue } from 'bullmq';
import { decodeImage, QuadmarkError, version } from 'quadmark';
import { reportQueue } from './connection.js';
import { checkRoots, inside, readInput, readModel } from './files.js';
import { contentHash, fingerprint, jobIdOf, runIdOf, sha256 } from './identity.js';

/** Tries of a job that failed for reasons that may pass, and milliseconds before the second; it doubles each time. */
export const RETRIES = Object.freeze({ attempts: 5, backoff: 1000 });

/** Exactly one of id, text and image, as JSON; the image decoded, so that a bad one fails here and not in every worker. */
async function describeMark({ id, text, image }) {
  if ([id, text, image].filter((given) => given !== undefined).length !== 1) {
    throw new QuadmarkError('bad_option', 'give exactly one of id, text and image');
  }
  if (id !== undefined) {
    if (!/^[0-9a-f]{1,16}$/i.test(id)) throw new QuadmarkError('bad_option', 'id: expected 1 to 16 hexadecimal digits');
    return { id: id.toLowerCase().padStart(16, '0') };
  }
  if (text !== undefined) return { text };
  const { width, height, bits } = await decodeImage(image);
  return { image: { width, height, bits: Buffer.from(bits).toString('base64') } };
}

/** A model as workers will read it; what they will refuse is queued all the same, to be told of in the report. */
async function readForHash(root, name) {
  try {
    return await readModel(root, name);
  } catch (error) {
    if (error.code === 'io' || error.code === 'bad_option') throw error;
    return { bytes: await readInput(inside(root, name)), resources: {}, names: {} };
  }
}

/** Refuses two models that would write the same file, their buffers included. */
function claim(claimed, name, input) {
  if (claimed.has(name) && claimed.get(name) !== input) {
    throw new QuadmarkError('bad_option', `${input} and ${claimed.get(name)} would both write ${name}`);
  }
  claimed.set(name, input);
}

/** Whether a finished job's files are still as it wrote them. */
async function outputsThere(outRoot, job) {
  for (const { name, sha256: expected } of job.returnvalue?.outputs ?? []) {
    const bytes = await readInput(inside(outRoot, name)).catch(() => null);
    if (bytes === null || sha256(bytes) !== expected) return false;
  }
  return true;
}

/**
 * Queues models. Documented in index.d.ts.
 * @return { run, jobs, added, earlier }
 */
export async function enqueue(redis, request) {
  const { queue, models, inRoot, outRoot, key, mark, options = {}, report } = request;
  const { attempts = RETRIES.attempts, backoff = RETRIES.backoff } = request;
  checkRoots(inRoot, outRoot);
  if (models.length === 0) throw new QuadmarkError('bad_option', 'there are no models to mark');
  const common = { version: await version(), key: await fingerprint(key), mark: await describeMark(mark), options };
  const claimed = new Map();
  const jobs = new Map();
  for (const { input, output } of models) {
    inside(outRoot, output);
    const model = await readForHash(inRoot, input);
    const content = contentHash(model);
    const beside = Object.fromEntries(Object.entries(model.names).map(([uri]) => [uri, join(dirname(output), decodeURIComponent(uri))]));
    for (const name of [output, ...Object.values(beside)]) claim(claimed, name, input);
    jobs.set(jobIdOf({ ...common, content, output }), { ...common, content, input, output, beside });
  }

  const run = runIdOf(jobs.keys(), report ?? null);
  const reportName = report ?? `quadmark-report-${run.slice(0, 12)}.json`;
  inside(outRoot, reportName);
  const marking = new Queue(queue, { connection: redis });
  const reports = new Queue(reportQueue(queue), { connection: redis });
  const flow = new FlowProducer({ connection: redis });
  try {
    const added = new Map();
    for (const [id, data] of jobs) {
      const job = await marking.getJob(id);
      if (job && (await job.isCompleted()) && !(await outputsThere(outRoot, job))) {
        await job.remove({ removeChildren: false });
        added.set(id, data);
      } else if (!job) {
        added.set(id, data);
      }
    }
    const result = { run, jobs: jobs.size, added: added.size, earlier: jobs.size - added.size, report: reportName };
    const parent = await reports.getJob(run);
    if (parent) {
      const finished = (await parent.isCompleted()) || (await parent.isFailed());
      const written = await stat(inside(outRoot, reportName)).catch(() => null);
      if (!finished || (added.size === 0 && written)) return result;
      await parent.remove({ removeChildren: false });
    }
    await flow.add({
      name: 'report',
      queueName: reportQueue(queue),
      data: { report: reportName, ...common, jobs: [...jobs].map(([id, { input, output }]) => ({ id, input, output })) },
      opts: { jobId: run, attempts, backoff: { type: 'exponential', delay: backoff } },
      children: [...added].map(([id, data]) => ({
        name: 'mark',
        queueName: queue,
        data,
        // A model that cannot be marked must not keep the report from being written: it is in there.
        opts: { jobId: id, attempts, backoff: { type: 'exponential', delay: backoff }, ignoreDependencyOnFailure: true },
      })),
    });
    return result;
  } finally {
    await Promise.all([marking.close(), reports.close(), flow.close()]);
  }
}
