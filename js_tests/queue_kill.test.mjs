// SPDX-License-Identifier: MIT
// Workers are killed in the middle of their work, and every model is marked exactly once all the same. The bench does
// this many times in a row: node bench/queue.mjs --kill 20
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { expectedOutputs, killRun, queueFolders, writeKillModels } from './support/queue.mjs';
import { hasRedis, startRedis } from './support/redis.mjs';

test('killing workers leaves every model marked once, and nothing half written', { skip: hasRedis ? false : 'no redis-server', timeout: 240_000 }, async (t) => {
  const redis = await startRedis(t);
  const folders = await queueFolders(t);
  await writeKillModels(folders.inRoot);
  const id = '00c0ffee';
  const expected = await expectedOutputs(folders.inRoot, folders.key, id);
  const done = await killRun(redis, folders, expected, { id, seed: 1 });
  t.diagnostic(JSON.stringify(done));
  assert.ok(done.kills >= 2, 'processes were killed');
  assert.ok(done.interrupted + done.retried >= 1, 'in the middle of their work');
});
