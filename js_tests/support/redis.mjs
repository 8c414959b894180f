// SPDX-License-Identifier: MIT
// A real Redis on a socket of its own, and the processes of a queue: started here, ended here, by their ids.
import { spawn, spawnSync } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { run, repository } from './files.mjs';
import { until } from './server.mjs';

const redisServer = process.env.QUADMARK_REDIS_SERVER ?? 'redis-server';
const queueFile = join(repository, 'queue/src/main.js');

/** Whether there is a Redis to test with; scripts/setup.sh sees to that. */
export const hasRedis = spawnSync(redisServer, ['--version']).status === 0;

/** Starts Redis: { url (path of its socket), stop() }. */
export async function startRedis(t) {
  const folder = mkdtempSync(join(tmpdir(), 'quadmark-redis-'));
  const socket = join(folder, 'redis.sock');
  const child = spawn(redisServer, ['--port', '0', '--unixsocket', socket, '--dir', folder, '--save', '', '--appendonly', 'no'], { stdio: 'ignore' });
  const exit = once(child, 'exit');
  const stop = async () => {
    child.kill('SIGTERM');
    await exit;
    rmSync(folder, { recursive: true, force: true });
  };
  t?.after(stop);
  await until(() => existsSync(socket), 'Redis listens');
  return { url: socket, stop };
}

/** quadmark-queue as its users run it. */
export const queueCommand = (redis, args) => run(process.execPath, [queueFile, ...args.map(String)], { env: { QUADMARK_REDIS_URL: redis.url } });

/** Starts a worker process and waits until it takes models: { process, kill(), stop(), exit, lines() }. */
export async function startWorkerProcess(redis, { inRoot, outRoot, keys, queue = 'quadmark', concurrency = 1, lock = 2, timeLimit = 600 }) {
  const args = ['work', '--json', '--in', inRoot, '--out', outRoot, '--keys', keys, '--queue', queue, '--concurrency', concurrency, '--lock', lock,
    '--time-limit', timeLimit].map(String);
  const child = spawn(process.execPath, [queueFile, ...args], {
    env: { ...process.env, QUADMARK_REDIS_URL: redis.url }, stdio: ['ignore', 'pipe', 'inherit'],
  });
  let text = '';
  child.stdout.on('data', (chunk) => { text += chunk; });
  const exit = once(child, 'exit');
  await until(() => text.includes('"ready":true') || child.exitCode !== null, 'the worker is ready');
  return {
    process: child,
    exit,
    lines: () => text.trim().split('\n').slice(1).map((line) => JSON.parse(line)),
    async kill() {
      child.kill('SIGKILL');
      await exit;
    },
    async stop() {
      child.kill('SIGTERM');
      return (await exit)[0];
    },
  };
}
