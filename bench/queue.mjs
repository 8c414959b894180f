// SPDX-License-Identifier: MIT
// The queue: throughput over workers, and the kill test many times in a row: the tables in docs/queue.md.
//
//   node bench/queue.mjs [--models N] [--kill RUNS] [--write]     --write replaces the tables that were made anew
//
// --models 0 leaves out the throughput; without --kill nobody is killed. Needs a redis-server (scripts/setup.sh).
import { mkdtempSync, readFileSync } from 'node:fs';
import { availableParallelism, cpus } from 'node:os';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { version } from 'quadmark';
import { connect, enqueue, fromFolder, runStatus } from 'quadmark-queue';
import { repository } from '../js_tests/support/files.mjs';
import { expectedOutputs, killRun, queueFolders, writeKillModels, writeModels } from '../js_tests/support/queue.mjs';
import { startRedis, startWorkerProcess } from '../js_tests/support/redis.mjs';
import { until } from '../js_tests/support/server.mjs';
import { replaceTable, tableOf } from './support/table.mjs';

const { values: options } = parseArgs({ options: {
  models: { type: 'string', default: '500' }, kill: { type: 'string', default: '0' }, write: { type: 'boolean' },
} });
const id = '00c0ffee';
const machine = `quadmark ${await version()}, ${cpus()[0].model}, ${availableParallelism()} processors, Node ${process.versions.node}, ${new Date().toISOString().slice(0, 10)}`;
const page = join(repository, 'docs/queue.md');

function finish(name, text) {
  console.log(text);
  if (options.write) replaceTable(page, name, text);
}

/** Seconds that `count` workers, all ready, take for all models of a folder, report included. */
async function timeRun(redis, folders, count) {
  const outRoot = mkdtempSync(join(folders.root, 'out-'));
  const queue = `speed-${count}`;
  const connection = await connect(redis.url);
  const workers = await Promise.all(Array.from({ length: count }, () =>
    startWorkerProcess(redis, { ...folders, outRoot, queue, lock: 30 })));
  try {
    const models = await fromFolder(folders.inRoot);
    const start = performance.now();
    const { run, report } = await enqueue(connection, {
      queue, models, inRoot: folders.inRoot, outRoot, key: folders.key, mark: { id },
    });
    const queued = performance.now();
    await until(async () => (await runStatus(connection, queue, run)).reported, 'the report is written', 3600);
    const seconds = (performance.now() - start) / 1000;
    const { marked } = JSON.parse(readFileSync(join(outRoot, report), 'utf8'));
    if (marked !== models.length) throw new Error(`${marked} of ${models.length} models were marked`);
    return { seconds, queueing: (queued - start) / 1000 };
  } finally {
    await Promise.all(workers.map((worker) => worker.stop()));
    connection.disconnect();
  }
}

async function throughput(redis, count) {
  const folders = await queueFolders();
  try {
    await writeModels(folders.inRoot, count);
    const rows = [];
    let single;
    for (const workers of [1, 2, 4]) {
      const { seconds, queueing } = await timeRun(redis, folders, workers);
      single ??= seconds;
      rows.push([workers, seconds.toFixed(1), queueing.toFixed(1), (count / seconds).toFixed(1), `${Math.round((100 * single) / (workers * seconds))} %`,
        `${Math.round((100 * single) / (Math.min(workers, availableParallelism()) * seconds))} %`]);
      console.error(rows.at(-1).join('  '));
    }
    const table = tableOf(['workers', 'seconds', 'of these queueing', 'models / s', 'efficiency per worker', 'efficiency per processor used'], rows);
    finish('throughput', `${machine}; ${count} generated models of about 3000 vertices, all workers on this machine.\n\n${table}`);
  } finally {
    folders.remove();
  }
}

async function kill(redis, runs) {
  const folders = await queueFolders();
  try {
    await writeKillModels(folders.inRoot);
    const expected = await expectedOutputs(folders.inRoot, folders.key, id);
    const total = { models: 0, kills: 0, interrupted: 0, retried: 0 };
    for (let seed = 1; seed <= runs; ++seed) {
      const done = await killRun(redis, folders, expected, { id, seed });
      for (const name of Object.keys(total)) total[name] += done[name];
      console.error(`run ${seed} of ${runs}: ${JSON.stringify(done)}`);
    }
    const table = tableOf(['runs in a row', 'models', 'processes killed', 'models whose worker was killed', 'models whose own process was killed', 'models marked once and whole'],
      [[runs, total.models, total.kills, total.interrupted, total.retried, total.models]]);
    finish('kill', `${machine}; 3 workers, SIGKILL to workers and to the processes in which they mark by turns.\n\n${table}`);
  } finally {
    folders.remove();
  }
}

const redis = await startRedis();
try {
  if (Number(options.models) > 0) await throughput(redis, Number(options.models));
  if (Number(options.kill) > 0) await kill(redis, Number(options.kill));
} finally {
  await redis.stop();
}
