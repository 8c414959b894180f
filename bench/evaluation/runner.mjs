// SPDX-License-Identifier: MIT
// Runs jobs on several workers at once, seed by seed, leaving out what the rows have already.
import { existsSync, mkdirSync } from 'node:fs';
import { dirname } from 'node:path';
import { isPresent, modelPath } from './models.mjs';
import { Worker } from './worker.mjs';

const placeOf = ({ scheme, settings, payload, model, seed }) => ({ scheme, settings, payload, model, seed });

const isRefused = (rows, place) => rows.select({ ...place, attack: 'mark', outcome: 'refused' }).length > 0;

/**
 * What is left of the jobs: one per scheme, settings, payload, model and seed, with all attacks that any experiment asks
 * for and that have no row; first seeds first. Models that are not there are left out: tables say so.
 *
 * @param jobs  { scheme, settings, payload, model, seed, attacks, pictures? }
 */
export function openJobs(jobs, rows) {
  const merged = new Map();
  for (const job of jobs) {
    if (!isPresent(job.model)) continue;
    const place = placeOf(job), name = JSON.stringify(place);
    const one = merged.get(name) ?? { ...place, attacks: new Set(), pictures: {} };
    merged.set(name, one);
    for (const attack of job.attacks) if (!rows.has({ ...place, attack })) one.attacks.add(attack);
    for (const [attack, file] of Object.entries(job.pictures ?? {})) {
      if (existsSync(file) || isRefused(rows, place)) continue;
      mkdirSync(dirname(file), { recursive: true });
      one.pictures[attack] = file;
      one.attacks.add(attack);
    }
  }
  return [...merged.values()]
    .map((job) => ({ ...job, attacks: [...job.attacks], mark: !rows.has({ ...placeOf(job), attack: 'mark' }) }))
    .filter((job) => job.mark || job.attacks.length > 0)
    .sort((a, b) => a.seed - b.seed);
}

/**
 * Measures. Rows are kept as they come.
 *
 * @param jobs      as openJobs() gives them
 * @param progress  (done, job) => void, after every row: `done` of the job, 0 to 1, once 1 when it ended
 * @return errors, as sentences; what they are about has no rows
 */
export async function runJobs(jobs, { rows, parallel, signal, progress }) {
  const errors = [];
  let next = 0;
  const serve = async () => {
    const worker = new Worker();
    const stop = () => worker.stop();
    signal?.addEventListener('abort', stop);
    try {
      while (next < jobs.length && !signal?.aborted) {
        const job = jobs[next++], all = job.attacks.length + Number(job.mark);
        let done = 0;
        try {
          await worker.run({ ...job, model: modelPath(job.model) }, (row) => {
            if (!rows.has(row)) rows.add(row);  // a picture may have been all that was missing
            if (++done < all) progress?.(done / all, job);
          });
        } catch (error) {
          if (signal?.aborted) break;
          errors.push(`${job.scheme} (${job.settings}), ${job.payload}, ${job.model}, seed ${job.seed}: ${error.message}`);
        }
        progress?.(1, job);
      }
    } finally {
      signal?.removeEventListener('abort', stop);
      worker.stop();
    }
  };
  await Promise.all(Array.from({ length: parallel }, serve));
  return errors;
}
