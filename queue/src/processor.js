// SPDX-License-Identifier: MIT
// One model at a time, in a process of its own: read, mark, write. Nothing here depends on how often it was tried before: equal
// jobs write equal bytes, and only complete files get their names.
import { embed, memoryBytes, QuadmarkError, unload } from 'quadmark';
import { inside, readModel, writeDurably } from './files.js';
import { contentHash, sha256 } from './identity.js';
import { findKey } from './keys.js';

const { inRoot, outRoot, keys } = JSON.parse(process.env.QUADMARK_QUEUE_WORKER);

const PROGRESS_MILLIS = 200;
const KEEP_BYTES = 256 * 2 ** 20;

/** Failures that another try, or another machine, may not have: everything else is the model's or the options' own. */
const MAY_PASS = ['io', 'internal', 'too_large'];

// The worker was killed: its lock on the job runs out, and another one takes over.
for (const event of ['disconnect', 'error']) process.once(event, () => process.exit(1));

function onProgress() {
  let last = 0;
  return ({ stage, done }) => {
    const now = performance.now();
    if (now - last < PROGRESS_MILLIS) return;
    last = now;
    process.send({ progress: { stage, done: Math.round(done * 100) / 100 } });
  };
}

async function markModel(job) {
  const { input, output, beside, content, key, mark, options } = job.data;
  const model = await readModel(inRoot, input);
  if (contentHash(model) !== content) {
    throw new QuadmarkError('bad_option', `${input} has changed since it was queued: queue it again`);
  }
  const payload = mark.image
    ? { image: { ...mark.image, bits: new Uint8Array(Buffer.from(mark.image.bits, 'base64')) } }
    : mark;
  const marked = await embed(model.bytes, {
    key: await findKey(keys, key), ...payload, resources: model.resources, options: { ...options, onProgress: onProgress() },
  });
  // The model last: what refers to other files must not be there before them.
  const files = Object.entries(model.resources).map(([uri, bytes]) => ({ name: beside[uri], bytes: marked.resources[uri] ?? bytes }));
  files.push({ name: output, bytes: marked.bytes });
  for (const { name, bytes } of files) await writeDurably(inside(outRoot, name), bytes, job.id);
  return {
    outputs: files.map(({ name, bytes }) => ({ name, bytes: bytes.length, sha256: sha256(bytes) })),
    report: marked.report,
  };
}

process.on('message', async (job) => {
  try {
    process.send({ result: await markModel(job) });
  } catch (error) {
    const { code, message } = error instanceof QuadmarkError ? error : { code: 'internal', message: error.stack };
    process.send({ error: { told: `${code}: ${message}`, final: !MAY_PASS.includes(code) } });
  } finally {
    if (memoryBytes() > KEEP_BYTES) unload();
  }
});
