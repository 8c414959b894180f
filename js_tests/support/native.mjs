// SPDX-License-Identifier: MIT
// The core's native build on bytes in memory, for comparing it with wasm. Null, after saying so, where it is not built.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { encodeImage } from 'quadmark';
import { repository, run, temporaryFolder } from './files.mjs';

const native = process.env.QUADMARK_NATIVE ?? join(repository, 'build/native/bench/quadmark_native');

async function runNative(t, files, args) {
  if (!existsSync(native)) {
    t.diagnostic(`${native} is not built: wasm alone was tested`);
    return null;
  }
  const folder = temporaryFolder(t);
  for (const [name, bytes] of Object.entries(files)) writeFileSync(join(folder, name), bytes);
  const { status, json, stderr } = await run(native, args, { cwd: folder });
  assert.equal(status, 0, stderr || JSON.stringify(json));
  return { folder, report: json[0] };
}

/** The inspect report of a model without resources. */
export async function inspectNatively(t, model) {
  return (await runNative(t, { model }, ['inspect', 'model']))?.report ?? null;
}

/** The bytes of a model without resources after marking. */
export async function embedNatively(t, model, key, image) {
  const files = { model, 'key.json': JSON.stringify(key), 'logo.png': await encodeImage(image) };
  const done = await runNative(t, files, ['embed', 'model', 'marked', 'key.json', 'image', 'logo.png']);
  return done && readFileSync(join(done.folder, 'marked'));
}
