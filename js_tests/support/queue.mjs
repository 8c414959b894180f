// SPDX-License-Identifier: MIT
// Folders for a queue, and the run in which processes are killed: used by the tests once and by the bench many times.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { Queue } from 'bullmq';
import { createKey, embed } from 'quadmark';
import { generate } from 'quadmark/lab';
import { connect, enqueue, fromFolder, runStatus, status } from 'quadmark-queue';
import { randomNumbers } from './random.mjs';
import { startWorkerProcess } from './redis.mjs';
import { until } from './server.mjs';

/** Folders in, out and keys with one key: { root, inRoot, outRoot, keys, keyFile, key, remove() }. */
export async function queueFolders(t) {
  const root = mkdtempSync(join(tmpdir(), 'quadmark-queue-'));
  const remove = () => rmSync(root, { recursive: true, force: true });
  t?.after(remove);
  const [inRoot, outRoot, keys] = ['in', 'out', 'keys'].map((name) => join(root, name));
  for (const folder of [inRoot, outRoot, keys]) mkdirSync(folder);
  const key = await createKey();
  const keyFile = join(keys, 'studio.json');
  writeFileSync(keyFile, JSON.stringify(key));
  return { root, inRoot, outRoot, keys, keyFile, key, remove };
}

/** Writes `count` different models of some thousand vertices into a folder. */
export async function writeModels(folder, count, vertices = 3000) {
  for (let seed = 1; seed <= count; ++seed) {
    const { bytes } = await generate({ name: 'sculpture', vertices: vertices + 10 * (seed % 50), seed, format: 'glb' });
    writeFileSync(join(folder, `model-${String(seed).padStart(4, '0')}.glb`), bytes);
  }
}

/** { name: bytes } of the models of a folder, marked here: what any worker must have written. */
export async function expectedOutputs(inRoot, key, id) {
  const outputs = {};
  for (const { input } of await fromFolder(inRoot)) outputs[input] = (await embed(readFileSync(join(inRoot, input)), { key, id })).bytes;
  return outputs;
}

/** Ids of the processes that `pid` has started; none when it has ended. */
function childrenOf(pid) {
  try {
    return readFileSync(`/proc/${pid}/task/${pid}/children`, 'utf8').trim().split(' ').filter(Boolean).map(Number);
  } catch {
    return [];
  }
}

function endProcess(pid) {
  try {
    process.kill(pid, 'SIGKILL');
  } catch (error) {
    if (error.code !== 'ESRCH') throw error;  // it was quicker
  }
}

/** Models for killRun(): enough work that there is something to disturb. */
export const writeKillModels = (folder) => writeModels(folder, 24, 20_000);

/**
 * Marks all models of a folder by several worker processes while SIGKILL ends one after the other in the middle of their
 * work, workers and the processes in which they mark by turns, and checks that nothing shows of it.
 *
 * @param redis     of startRedis()
 * @param folders   of queueFolders(), with models
 * @param expected  of expectedOutputs()
 * @param seed      of the moments at which processes are killed
 * @return { models, kills, interrupted: jobs that lost their worker, retried: jobs whose process was killed }
 */
export async function killRun(redis, { inRoot, key, keys, root }, expected, { id, seed, workers = 3, kills = 6 }) {
  const outRoot = mkdtempSync(join(root, 'killed-'));
  const queue = `kill-${seed}`;
  const random = randomNumbers(seed * 7919);
  const names = Object.keys(expected);
  const connection = await connect(redis.url);
  const models = new Queue(queue, { connection });
  const running = [];
  const starting = [];
  const start = () => {
    starting.push(startWorkerProcess(redis, { inRoot, outRoot, keys, lock: 1, queue }).then((worker) => running.push(worker)));
    return starting.at(-1);
  };
  try {
    await Promise.all(Array.from({ length: workers }, start));
    const { run, report } = await enqueue(connection, {
      queue, models: await fromFolder(inRoot), inRoot, outRoot, key: JSON.stringify(key), mark: { id }, attempts: 10, backoff: 100,
    });
    let killed = 0;
    for (let kill = 0; kill < kills; ++kill) {
      const due = Math.floor(((kill + 1) * names.length) / (kills + 2));
      await until(async () => (await status(connection, queue)).completed >= due, `${due} models are done`);
      await sleep(random() * 100);
      const now = await status(connection, queue);
      if (now.completed === names.length) break;  // too late to disturb
      if (now.active === 0) continue;
      await until(() => running.length > 0, 'there is a worker');
      const victim = running[Math.floor(random() * running.length)];
      if (kill % 2 === 0) {
        await victim.kill();
        running.splice(running.indexOf(victim), 1);
        start();  // the others work on meanwhile
        ++killed;
      } else {
        const children = childrenOf(victim.process.pid);
        children.forEach(endProcess);
        if (children.length > 0) ++killed;
      }
    }
    await until(async () => (await runStatus(connection, queue, run)).reported, 'the report is written', 120);

    const counts = await status(connection, queue);
    assert.deepEqual(counts, { waiting: 0, delayed: 0, active: 0, completed: names.length, failed: 0, working: [] });
    assert.deepEqual(readdirSync(outRoot).sort(), [...names, report].sort(), 'nothing is missing, nothing half written is left');
    for (const name of names) assert.ok(readFileSync(join(outRoot, name)).equals(expected[name]), `${name} is marked once, and whole`);
    const told = JSON.parse(readFileSync(join(outRoot, report), 'utf8'));
    assert.equal(told.marked, names.length);
    assert.deepEqual(told.results.map(({ output }) => output).sort(), [...names].sort());
    const jobs = await models.getCompleted();
    assert.equal(new Set(jobs.map((job) => job.id)).size, names.length);
    return {
      models: names.length,
      kills: killed,
      interrupted: jobs.filter((job) => job.stalledCounter > 0).length,
      retried: jobs.filter((job) => job.attemptsMade > 1).length,
    };
  } finally {
    await Promise.allSettled(starting);
    await Promise.all(running.map((worker) => worker.kill()));
    await models.close();
    connection.disconnect();
    rmSync(outRoot, { recursive: true, force: true });
  }
}
