// SPDX-License-Identifier: MIT
// examples/queue as its user runs it: workers, and the step of a build that waits for them.
import assert from 'node:assert/strict';
import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { extract } from 'quadmark';
import { realModels, repository, run } from './support/files.mjs';
import { queueFolders, writeModels } from './support/queue.mjs';
import { hasRedis, startRedis, startWorkerProcess } from './support/redis.mjs';

test('examples/queue marks a folder by two workers', { skip: hasRedis ? false : 'no redis-server', timeout: 240_000 }, async (t) => {
  const redis = await startRedis();
  const folders = await queueFolders(t);
  const workers = await Promise.all([1, 2].map(() => startWorkerProcess(redis, folders)));
  t.after(async () => {
    await Promise.all(workers.map((worker) => worker.kill()));
    await redis.stop();
  });
  await writeModels(folders.inRoot, 3);
  for (const { name, path } of realModels(t, ['fandisk.glb', 'Duck.glb'])) copyFileSync(path, join(folders.inRoot, name));
  const build = () => run(process.execPath,
    [join(repository, 'examples/queue/build.mjs'), folders.inRoot, folders.outRoot, folders.keyFile, 'C0FFEE'], { env: { QUADMARK_REDIS_URL: redis.url } });
  const first = await build();
  assert.equal(first.status, 0, first.stderr);
  const marked = readFileSync(join(folders.outRoot, 'model-0002.glb'));
  assert.equal((await extract(marked, { key: folders.key })).id, '0000000000c0ffee');
  writeFileSync(join(folders.inRoot, 'broken.glb'), 'glTF');
  const second = await build();
  assert.equal(second.status, 1);
  assert.match(second.stdout.toString(), /^1 models to mark, [35] were marked before/);
  assert.match(second.stderr, /broken\.glb: /);
});
