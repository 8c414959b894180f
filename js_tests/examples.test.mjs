// SPDX-License-Identifier: MIT
// The build scripts under examples/ do what they say, in a project that has the packages they name.
import assert from 'node:assert/strict';
import { chmodSync, cpSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import { delimiter, join } from 'node:path';
import { test } from 'node:test';
import { extract } from 'quadmark';
import { cliFile, realModel, repository, run, temporaryFolder } from './support/files.mjs';
import { fixedRobustKey, sculpture } from './support/marks.mjs';

const key = await fixedRobustKey();

/** A copy of an example with node_modules, key.json, model.glb and the command quadmark. */
async function project(t, name) {
  const folder = temporaryFolder(t);
  cpSync(join(repository, 'examples', name), folder, { recursive: true });
  symlinkSync(join(repository, 'node_modules'), join(folder, 'node_modules'));
  mkdirSync(join(folder, 'bin'));
  symlinkSync(cliFile, join(folder, 'bin/quadmark'));
  writeFileSync(join(folder, 'key.json'), JSON.stringify(key));
  const duck = realModel(t, 'Duck.glb');
  writeFileSync(join(folder, 'model.glb'), duck === null ? await sculpture('glb') : readFileSync(duck));
  const env = { PATH: `${join(folder, 'bin')}${delimiter}${process.env.PATH}` };
  const read = (path) => readFileSync(join(folder, path));
  const ok = async (program, ...args) => {
    const result = await run(program, args, { cwd: folder, env });
    assert.equal(result.status, 0, `${result.stdout}${result.stderr}`);
    return result.stdout.toString();
  };
  return { folder, read, ok, idOf: async (path) => (await extract(read(path), { key })).id };
}

test('command-line/build.sh marks a folder', async (t) => {
  const { folder, read, ok, idOf } = await project(t, 'command-line');
  mkdirSync(join(folder, 'models/more'), { recursive: true });
  cpSync(join(folder, 'model.glb'), join(folder, 'models/one.glb'));
  cpSync(join(folder, 'model.glb'), join(folder, 'models/more/two.glb'));
  chmodSync(join(folder, 'build.sh'), 0o755);
  await ok('./build.sh', 'models', 'key.json', 'C0FFEE', 'out');
  assert.equal(await idOf('out/two.glb'), '0000000000c0ffee');
  assert.deepEqual(read('out/check.jsonl').toString().trim().split('\n').map((line) => JSON.parse(line).verdict), ['match', 'match']);
});

test('command-line/recipients.sh marks copies and traces one', async (t) => {
  const { folder, ok } = await project(t, 'command-line');
  writeFileSync(join(folder, 'list.csv'), 'recipient\r\nAlice\r\nBob\r\n');
  await ok('./recipients.sh', 'model.glb', 'list.csv', 'key.json', 'out');
  assert.match(await ok('./recipients.sh', '--trace', 'out/Bob/model.glb', 'key.json', 'out'), /: Bob\n/);
});

test('gltf-transform/mark.mjs and quadmark.config.mjs mark', async (t) => {
  const { ok, idOf } = await project(t, 'gltf-transform');
  assert.match(await ok(process.execPath, 'mark.mjs', 'key.json', 'model.glb', 'out.glb', 'abc'), /capacity \w+, SNR/);
  assert.equal(await idOf('out.glb'), '0000000000000abc');
  await ok('node_modules/.bin/gltf-transform', '--config', 'quadmark.config.mjs', 'mark', 'model.glb', 'cli.glb', '--key', 'key.json', '--id', 'def');
  assert.equal(await idOf('cli.glb'), '0000000000000def');
});
