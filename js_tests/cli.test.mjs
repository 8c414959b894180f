// SPDX-License-Identifier: MIT
// The command line as a user runs it, when all goes well.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { openGltf, splitGlb } from './support/gltf.mjs';
import { quadmark, temporaryFolder } from './support/files.mjs';
import { logo, logoPng, packBits, sculpture } from './support/marks.mjs';
import { readPng } from './support/png.mjs';

const image = logo();
const ply = await sculpture('ply', 4000);
const glb = await sculpture('glb', 4000);

/** A folder with logo.png, key.json and the named files. */
async function workspace(t, files = {}) {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, 'logo.png'), logoPng(image));
  for (const [name, bytes] of Object.entries(files)) {
    mkdirSync(join(folder, name, '..'), { recursive: true });
    writeFileSync(join(folder, name), bytes);
  }
  const made = await quadmark(['keygen', 'key.json', '--image', 'logo.png', '--owner', 'the tests'], { cwd: folder });
  assert.equal(made.status, 0, made.stderr);
  return { folder, path: (name) => join(folder, name), cli: (args, options) => quadmark(args, { cwd: folder, ...options }) };
}

test('keygen, embed and extract work in a row', async (t) => {
  const { path, cli, folder } = await workspace(t, { 'in.ply': ply });
  assert.equal(statSync(path('key.json')).mode & 0o077, 0, 'the key is for its owner alone');
  const embedded = await cli(['embed', 'in.ply', 'out.ply', '--key', 'key.json', '--image', 'logo.png']);
  assert.equal(embedded.status, 0, embedded.stderr);
  assert.match(embedded.stdout.toString(), /576 bits/);
  const read = await cli(['extract', 'out.ply', '--key', 'key.json', '--image-out', 'mark.png', '--confidence-out', 'map.png']);
  assert.equal(read.status, 0, read.stderr);
  assert.match(read.stdout.toString(), /match/);
  const { levels } = readPng(readFileSync(path('mark.png')));
  assert.deepEqual(Uint8Array.from(levels, (level) => (level < 128 ? 1 : 0)), image.bits);
  assert.equal(readPng(readFileSync(path('map.png'))).width, 24);
  assert.deepEqual(readdirSync(folder).sort(), ['in.ply', 'key.json', 'logo.png', 'map.png', 'mark.png', 'out.ply'], 'nothing else is left');
});

test('--json prints one object per input and nothing else', async (t) => {
  const { cli } = await workspace(t, { 'in.ply': ply });
  const embedded = await cli(['embed', 'in.ply', 'out.ply', '--key', 'key.json', '--image', 'logo.png', '--json']);
  assert.equal(embedded.json.length, 1);
  const [report] = embedded.json;
  assert.deepEqual([report.command, report.input, report.output, report.scheme], ['embed', 'in.ply', 'out.ply', 'paper']);
  for (const name of ['cells', 'capacityBits', 'payloadBits', 'bytesChanged', 'millis']) assert.equal(typeof report[name], 'number', name);
  assert.equal(typeof report.distortion.snrDb, 'number');

  const read = await cli(['extract', 'out.ply', 'in.ply', 'key.json', '--key', 'key.json', '--reference', 'logo.png', '--json']);
  const [marked, plain, broken] = read.json;
  assert.equal(read.json.length, 3);
  assert.deepEqual([marked.command, marked.input, marked.verdict, marked.ber], ['extract', 'out.ply', 'match', 0]);
  assert.equal(marked.image.bits, packBits(image));
  assert.deepEqual([plain.input, plain.verdict], ['in.ply', 'none']);
  assert.deepEqual([broken.input, broken.error.code], ['key.json', 'bad_file']);
  assert.equal(read.status, 1, 'a failure outweighs verdicts');

  const facts = await cli(['inspect', 'in.ply', 'out.ply', '--json']);
  assert.deepEqual(facts.json.map(({ command, input, format }) => [command, input, format]), [['inspect', 'in.ply', 'ply'], ['inspect', 'out.ply', 'ply']]);
  const attacked = await cli(['attack', 'out.ply', 'cut.glb', '--kind', 'crop', '--amount', '0.25', '--json']);
  assert.deepEqual([attacked.json[0].kind, attacked.json[0].amount, attacked.json[0].format], ['crop', 0.25, 'glb']);
  const key = await cli(['keygen', 'id.json', '--id-bits', '64', '--json']);
  assert.equal(key.json[0].command, 'keygen');
});

test('no mark is exit 3, and the secret is never printed', async (t) => {
  const { path, cli } = await workspace(t, { 'in.ply': ply });
  const read = await cli(['extract', 'in.ply', '--key', 'key.json']);
  assert.equal(read.status, 3, read.stderr);
  assert.match(read.stdout.toString(), /none/);
  const made = await cli(['keygen', 'second.json', '--size', '24x24', '--json']);
  const { secret } = JSON.parse(readFileSync(path('second.json')));
  assert.equal((made.stdout + made.stderr).includes(secret), false);
});

test('the key may come from the environment', async (t) => {
  const { cli } = await workspace(t, { 'in.ply': ply });
  const env = { QUADMARK_KEY_FILE: 'key.json' };
  assert.equal((await cli(['embed', 'in.ply', 'out.ply', '--image', 'logo.png'], { env })).status, 0);
  assert.equal((await cli(['extract', 'out.ply'], { env })).status, 0);
});

test('standard input and output carry models', async (t) => {
  const { cli } = await workspace(t);
  const marked = await cli(['embed', '-', '-', '--key', 'key.json', '--image', 'logo.png'], { input: glb });
  assert.equal(marked.status, 0, marked.stderr);
  assert.equal(marked.stdout.toString('latin1', 0, 4), 'glTF');
  assert.match(marked.stderr, /576 bits/);
  const read = await cli(['extract', '-', '--key', 'key.json', '--json'], { input: marked.stdout });
  assert.deepEqual([read.json[0].input, read.json[0].verdict], ['-', 'match']);
  const picture = await cli(['extract', '-', '--key', 'key.json', '--image-out', '-'], { input: marked.stdout });
  assert.equal(readPng(picture.stdout).width, 24);
  const attacked = await cli(['attack', '-', '-', '--kind', 'reorder', '--format', 'glb'], { input: marked.stdout });
  assert.equal(attacked.stdout.toString('latin1', 0, 4), 'glTF');
});

test('a 64-bit ID goes in and comes out', async (t) => {
  const { cli } = await workspace(t, { 'in.glb': glb });
  await cli(['keygen', 'id.json', '--id-bits', '64']);
  assert.equal((await cli(['embed', 'in.glb', 'out.glb', '--key', 'id.json', '--id', 'C0FFEE'])).status, 0);
  const read = await cli(['extract', 'out.glb', '--key', 'id.json', '--json']);
  assert.equal(read.json[0].id, '0000000000c0ffee');
});

test('globs and --out-dir take many inputs', async (t) => {
  const { folder, path, cli } = await workspace(t, { 'a.ply': ply, 'b.glb': glb, 'deep/er/c.ply': ply, 'x.txt': 'no model' });
  const embedded = await cli(['embed', '[!b-z].p?y', 'b.{glb,obj}', 'deep/**/*.ply', '--out-dir', 'marked', '--key', 'key.json', '--image', 'logo.png', '--json']);
  assert.equal(embedded.status, 0, embedded.stderr);
  assert.deepEqual(embedded.json.map(({ output }) => output), ['marked/a.ply', 'marked/b.glb', 'marked/c.ply']);
  assert.deepEqual(readdirSync(path('marked')).sort(), ['a.ply', 'b.glb', 'c.ply']);
  const read = await cli(['extract', 'marked/*', '--key', 'key.json', '--out-dir', 'pictures', '--json']);
  assert.deepEqual(read.json.map(({ verdict }) => verdict), ['match', 'match', 'match']);
  assert.deepEqual(readdirSync(path('pictures')).sort(), ['a', 'b', 'c'].flatMap((name) => [`${name}.confidence.png`, `${name}.mark.png`]));
  const again = await cli(['embed', 'a.ply', '--out-dir', 'marked', '--key', 'key.json', '--image', 'logo.png']);
  assert.equal(again.status, 1);
  assert.equal((await cli(['embed', 'a.ply', '--out-dir', 'marked', '--key', 'key.json', '--image', 'logo.png', '--force'])).status, 0);
  assert.ok(existsSync(join(folder, 'x.txt')));
});

test('--jobs handles several inputs at once, with the same results in the same order', async (t) => {
  const files = Object.fromEntries(['a', 'b', 'c', 'd', 'e'].map((name) => [`${name}.ply`, name === 'c' ? 'no model' : ply]));
  const { path, cli } = await workspace(t, files);
  const run = (jobs, out) =>
    cli(['embed', '?.ply', '--out-dir', out, '--key', 'key.json', '--image', 'logo.png', '--json', '--jobs', jobs]);
  const [one, three] = [await run('1', 'one'), await run('3', 'three')];
  assert.equal(three.status, 1, three.stderr);
  const strip = ({ json }) => json.map(({ millis, output, ...report }) => report);
  assert.deepEqual(strip(three), strip(one));
  assert.deepEqual(three.json.map(({ input }) => input), Object.keys(files));
  assert.equal(three.json[2].error.code, 'bad_file');
  for (const name of ['a', 'b', 'd', 'e']) {
    assert.equal(Buffer.compare(readFileSync(path(`one/${name}.ply`)), readFileSync(path(`three/${name}.ply`))), 0);
  }
  const read = await cli(['extract', 'three/*.ply', '--key', 'key.json', '--json', '--jobs', '0']);
  assert.deepEqual(read.json.map(({ verdict }) => verdict), ['match', 'match', 'match', 'match']);
  assert.equal(read.status, 0);
  assert.equal((await cli(['inspect', 'three/*.ply', '--json', '--jobs', '2'])).json.length, 4);
});

test('external buffers and images are written beside the output', async (t) => {
  const { gltf, bin } = splitGlb(glb, 'data/mesh%20one.bin');
  const json = JSON.parse(gltf);
  json.images = [{ uri: 'skin.png' }, { uri: 'missing.png' }];
  const { path, cli } = await workspace(t, {
    'model/m.gltf': JSON.stringify(json), 'model/data/mesh one.bin': bin, 'model/skin.png': 'pixels',
  });
  const embedded = await cli(['embed', 'model/m.gltf', 'out/m.gltf', '--key', 'key.json', '--image', 'logo.png']);
  assert.equal(embedded.status, 1, 'the directory of OUT itself must exist');
  mkdirSync(path('out'));
  const done = await cli(['embed', 'model/m.gltf', 'out/m.gltf', '--key', 'key.json', '--image', 'logo.png', '--json']);
  assert.equal(done.status, 0, done.stderr);
  assert.match(done.json[0].warnings.join(), /missing\.png/);
  assert.equal(readFileSync(path('out/skin.png'), 'utf8'), 'pixels');
  assert.notEqual(Buffer.compare(readFileSync(path('out/data/mesh one.bin')), bin), 0);
  assert.equal(Buffer.compare(readFileSync(path('model/data/mesh one.bin')), bin), 0, 'the input is left alone');
  assert.equal((await cli(['extract', 'out/m.gltf', '--key', 'key.json'])).status, 0);
  assert.equal(openGltf(readFileSync(path('out/m.gltf'))).json.buffers[0].uri, 'data/mesh%20one.bin');
});

test('--set changes parameters of a new key and of a run', async (t) => {
  const { path, cli } = await workspace(t, { 'in.ply': ply });
  const made = await cli(['keygen', 'k.json', '--size', '24x24', '-L', '3', '--keyed-cells', '--set', 'lambda=0.002', '--set', 'k=1']);
  assert.equal(made.status, 0, made.stderr);
  const { params } = JSON.parse(readFileSync(path('k.json')));
  assert.deepEqual([params.L1, params.lambda, params.k, params.keyedCells], [3, 0.002, 1, true]);
  const strict = await cli(['embed', 'in.ply', 'out.ply', '--key', 'key.json', '--image', 'logo.png', '--set', 'lambda=0.0005', '--json']);
  const loose = await cli(['embed', 'in.ply', 'out.ply', '--force', '--key', 'key.json', '--image', 'logo.png', '--set', 'lambda=0.002', '--json']);
  assert.ok(strict.json[0].cells < loose.json[0].cells);
});

test('help and version go to standard output and succeed', async () => {
  for (const args of [['--help'], ['embed', '--help'], ['--version'], ['help', 'extract']]) {
    const { status, stdout, stderr } = await quadmark(args);
    assert.equal(status, 0);
    assert.equal(stderr, '');
    assert.ok(stdout.length > 4);
  }
});

test('--quiet prints nothing when all goes well', async (t) => {
  const { cli } = await workspace(t, { 'in.ply': ply });
  const { status, stdout, stderr } = await cli(['embed', 'in.ply', 'out.ply', '--key', 'key.json', '--image', 'logo.png', '--quiet']);
  assert.deepEqual([status, stdout.length, stderr], [0, 0, '']);
});
