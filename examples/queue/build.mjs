// SPDX-License-Identifier: MIT
// build.mjs IN OUT KEY-FILE ID: has all models of the folder IN marked into OUT by the workers of the queue.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { connect, DEFAULT_QUEUE, enqueue, fromFolder, runStatus } from 'quadmark-queue';

const [inRoot, outRoot, keyFile, id] = process.argv.slice(2);
const redis = await connect(process.env.QUADMARK_REDIS_URL);
try {
  const { run, report, added, earlier } = await enqueue(redis, {
    queue: DEFAULT_QUEUE, models: await fromFolder(inRoot), inRoot, outRoot, key: await readFile(keyFile), mark: { id },
  });
  console.log(`${added} models to mark, ${earlier} were marked before`);
  let at = await runStatus(redis, DEFAULT_QUEUE, run);
  for (; !at.reported && at.failed === null; at = await runStatus(redis, DEFAULT_QUEUE, run)) {
    await sleep(200);
  }
  const { results } = JSON.parse(await readFile(join(outRoot, report), 'utf8'));
  for (const { input, status, error } of results) {
    if (status === 'marked') continue;
    console.error(`${input}: ${error?.message ?? status}`);
    process.exitCode = 1;
  }
} finally {
  redis.disconnect();
}
