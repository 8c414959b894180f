// SPDX-License-Identifier: MIT
// examples/http as its user runs it: a folder of models, marked by curl.
import assert from 'node:assert/strict';
import { copyFileSync, existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey, extract } from 'quadmark';
import { realModel, repository, run, temporaryFolder } from './support/files.mjs';
import { sculpture } from './support/marks.mjs';
import { keyDirectory, startServer } from './support/server.mjs';

test('examples/http marks a folder', async (t) => {
  const folder = temporaryFolder(t);
  const models = temporaryFolder(t);
  const key = await createKey();
  const server = await startServer(t, keyDirectory(folder, { studio: key }));
  const names = ['sculpture.glb', 'sculpture.ply'];
  for (const name of names) writeFileSync(join(models, name), await sculpture(name.slice(-3), 3000));
  for (const name of ['fandisk.glb', 'rocker-arm.ply']) {
    const path = realModel(t, name);
    if (!path) continue;
    copyFileSync(path, join(models, name));
    names.push(name);
  }
  const script = join(repository, 'examples/http/mark.sh');
  const { status, stderr } = await run(script, [models, server.url, 'studio', 'C0FFEE']);
  assert.equal(status, 0, stderr);
  for (const name of names) {
    const marked = readFileSync(join(models, 'marked', name));
    assert.equal((await extract(marked, { key })).id, '0000000000c0ffee', name);
    assert.equal(JSON.parse(readFileSync(join(models, 'marked', `${name}.json`))).verdict, 'match');
  }
  writeFileSync(join(models, 'broken.glb'), 'glTF');
  const again = await run(script, [models, server.url, 'studio', 'C0FFEE']);
  assert.equal(again.status, 1);
  assert.match(again.stderr, /broken\.glb: not marked: .*bad_file/);
  assert.ok(!existsSync(join(models, 'marked/broken.glb')));
});
