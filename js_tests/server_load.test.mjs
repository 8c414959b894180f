// SPDX-License-Identifier: MIT
// The HTTP endpoint under load: every answer is right, and the memory comes back. Longer, and with times: bench/server.mjs
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { createKey } from 'quadmark';
import { temporaryFolder } from './support/files.mjs';
import { loadRun, requestKinds } from './support/load.mjs';
import { keyDirectory, metricOf, startServer } from './support/server.mjs';

test('mixed requests at concurrency 32, some hostile, get their answers, and nothing is left of them', { timeout: 240_000 }, async (t) => {
  const key = await createKey();
  const server = await startServer(t, keyDirectory(temporaryFolder(t), { studio: key }), { threads: 2, queue: 64, bodyLimitMiB: 2 });
  const kinds = await requestKinds(key, 2);
  const resident = () => metricOf(server.url, 'process_resident_memory_bytes');
  await loadRun(server.url, kinds, { count: 220, connections: 32, seed: 1 });
  const warm = await resident();
  const { hostile } = await loadRun(server.url, kinds, { count: 220, connections: 32, seed: 2 });
  assert.equal(hostile, 11);
  const after = await resident();
  t.diagnostic(`resident: ${Math.round(warm / 2 ** 20)} MiB warm, ${Math.round(after / 2 ** 20)} MiB after`);
  assert.ok(after < warm * 1.3, `${after} bytes after, ${warm} before`);
  assert.equal(await metricOf(server.url, 'quadmark_requests_inside'), 0);
  assert.equal(await metricOf(server.url, 'quadmark_threads_ended'), 0, 'no thread was lost');
  assert.equal(await server.stop(), 0);
});
