// SPDX-License-Identifier: MIT
// The package as npm delivers it: packed, installed into an empty folder, run once for success and once for failure.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { repository, run, temporaryFolder } from './support/files.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';

const npm = (args, cwd) => run('npm', [...args, '--no-audit', '--no-fund'], { cwd });

test('the tarball works in an empty folder', { timeout: 180000 }, async (t) => {
  const folder = temporaryFolder(t);
  const packed = await npm(['pack', '--json', '--pack-destination', folder], join(repository, 'node'));
  assert.equal(packed.status, 0, packed.stderr);
  const [{ filename, files }] = JSON.parse(packed.stdout);
  const names = files.map(({ path }) => path);
  for (const name of ['package.json', 'README.md', 'LICENSE', 'dist/quadmark.js', 'dist/quadmark.wasm', 'dist/quadmark_draco.js', 'dist/quadmark_draco.wasm', 'src/index.d.ts', 'src/cli/main.js', 'man/quadmark.1']) {
    assert.ok(names.includes(name), `${name} is packed`);
  }
  for (const name of names) assert.match(name, /^(package\.json|README\.md|LICENSE|(src|dist|man)\/[\w/.]+)$/, 'nothing else is packed');
  const manifest = JSON.parse(readFileSync(join(repository, 'node/package.json')));
  assert.equal(manifest.scripts?.install ?? manifest.scripts?.postinstall, undefined, 'no install scripts');
  assert.ok(Object.keys(manifest.dependencies).length <= 6, 'few dependencies');

  const app = join(folder, 'app');
  mkdirSync(app);
  writeFileSync(join(app, 'package.json'), JSON.stringify({ name: 'app', private: true, type: 'module' }));
  // The dependencies come packed from our own node_modules, so that the test needs no network.
  const tarballs = [join(folder, filename)];
  for (const name of Object.keys(manifest.dependencies)) {
    const dependency = await npm(['pack', '--json', '--pack-destination', folder], join(repository, 'node_modules', name));
    assert.equal(dependency.status, 0, dependency.stderr);
    tarballs.push(join(folder, JSON.parse(dependency.stdout)[0].filename));
  }
  const installed = await npm(['install', '--offline', ...tarballs], app);
  assert.equal(installed.status, 0, installed.stderr);
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
  const script = await run(process.execPath, ['main.js'], { cwd: app });
  assert.equal(script.stdout.toString(), 'match\nbad_file\n', script.stderr);

  const bin = join(app, 'node_modules/.bin/quadmark');
  assert.equal((await run(bin, ['keygen', 'key.json', '--image', 'logo.png'], { cwd: app })).status, 0);
  assert.equal((await run(bin, ['embed', 'in.glb', 'out.glb', '--key', 'key.json', '--image', 'logo.png'], { cwd: app })).status, 0);
  assert.equal((await run(bin, ['extract', 'out.glb', '--key', 'key.json'], { cwd: app })).status, 0);
  assert.equal((await run(bin, ['extract', 'in.glb', '--key', 'key.json'], { cwd: app })).status, 3);
  assert.equal((await run(bin, ['extract', 'absent.glb', '--key', 'key.json'], { cwd: app })).status, 1);
});

test('the product\'s module carries none of the laboratory and stays small', () => {
  const wasm = readFileSync(join(repository, 'node/dist/quadmark.wasm'));
  const glue = readFileSync(join(repository, 'node/dist/quadmark.js'));
  assert.equal(wasm.includes('local-noise'), false);
  const kilobytes = Math.round((gzipSync(wasm).length + gzipSync(glue).length) / 1024);
  assert.ok(kilobytes < 400, `${kilobytes} kB gzipped`);
});
