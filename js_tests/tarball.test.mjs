// SPDX-License-Identifier: MIT
// The package as npm delivers it: packed, installed into an empty folder, run once for success and once for failure.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { repository, run } from './support/files.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';
import { installedPackage, manifest } from './support/packed.mjs';

test('the tarball works in an empty folder', { timeout: 180000 }, async (t) => {
  const { app, names } = await installedPackage(t);
  for (const name of ['package.json', 'README.md', 'LICENSE', 'dist/quadmark.js', 'dist/quadmark.wasm', 'dist/quadmark_draco.js', 'dist/quadmark_draco.wasm', 'src/index.d.ts', 'src/cli/main.js', 'man/quadmark.1']) {
    assert.ok(names.includes(name), `${name} is packed`);
  }
  for (const name of names) assert.match(name, /^(package\.json|README\.md|LICENSE|(src|dist|man)\/[\w/.]+)$/, 'nothing else is packed');
  for (const script of ['preinstall', 'install', 'postinstall', 'prepare']) assert.equal(manifest.scripts?.[script], undefined, 'no install scripts');
  assert.ok(Object.keys(manifest.dependencies).length <= 6, 'few dependencies');
  assert.ok(existsSync(join(app, 'node_modules/.bin/quadmark')));

  writeFileSync(join(app, 'logo.png'), logoPng(logo()));
  writeFileSync(join(app, 'in.glb'), await sculpture('glb'));
  writeFileSync(join(app, 'main.js'), `
    import { readFile } from 'node:fs/promises';
    import { createKey, embed, extract } from 'quadmark';
    const [model, image] = await Promise.all([readFile('in.glb'), readFile('logo.png')]);
    const key = await createKey({ width: 24, height: 24 });
    const { bytes } = await embed(model, { key, image });
    console.log((await extract(bytes, { key })).verdict);
    await embed(new Uint8Array(3), { key, image }).catch(({ code }) => console.log(code));
  `);
  const cli = join(app, 'node_modules/quadmark/src/cli/main.js');
  for (const { version, node } of nodesIn(t)) {
    const script = await run(node, ['--disallow-code-generation-from-strings', 'main.js'], { cwd: app });
    assert.equal(script.stdout.toString(), 'match\nbad_file\n', `Node ${version}: ${script.stderr}`);
    const status = async (...args) => {
      const result = await run(node, [cli, ...args], { cwd: app });
      return result.status;
    };
    assert.equal(await status('keygen', 'key.json', '--image', 'logo.png', '--force'), 0, version);
    assert.equal(await status('embed', 'in.glb', 'out.glb', '--key', 'key.json', '--image', 'logo.png', '--force'), 0, version);
    assert.equal(await status('extract', 'out.glb', '--key', 'key.json'), 0, version);
    assert.equal(await status('extract', 'out.glb', 'in.glb', '--key', 'key.json', '--jobs', '2'), 3, version);
    assert.equal(await status('extract', 'absent.glb', '--key', 'key.json'), 1, version);
  }
  const bin = await run(join(app, 'node_modules/.bin/quadmark'), ['--version'], { cwd: app });
  assert.equal(bin.stdout.toString().trim(), manifest.version);
});

/** [{ version, node }]: this Node and those that scripts/setup.sh fetched. */
function nodesIn(t) {
  const found = ['20', '22', '24'].flatMap((version) => {
    const node = join(repository, 'build/deps/nodes/node_modules', `node${version}`, 'bin/node');
    if (existsSync(node)) return [{ version, node }];
    t.diagnostic(`Node ${version} is not in build/deps/nodes (run scripts/setup.sh): the package was not tested with it`);
    return [];
  });
  return [{ version: process.version, node: process.execPath }, ...found];
}

test('the product\'s module carries none of the laboratory and stays small', () => {
  const wasm = readFileSync(join(repository, 'node/dist/quadmark.wasm'));
  const glue = readFileSync(join(repository, 'node/dist/quadmark.js'));
  assert.equal(wasm.includes('local-noise'), false);
  const kilobytes = Math.round((gzipSync(wasm).length + gzipSync(glue).length) / 1024);
  assert.ok(kilobytes < 400, `${kilobytes} kB gzipped`);
});
