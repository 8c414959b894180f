// SPDX-License-Identifier: MIT
// What the command line refuses, with which exit status, and that it leaves nothing behind when it does.
import assert from 'node:assert/strict';
import { chmodSync, linkSync, mkdirSync, readFileSync, readdirSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey } from 'quadmark';
import { splitGlb } from './support/gltf.mjs';
import { quadmark, temporaryFolder } from './support/files.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';

const ply = await sculpture('ply', 1500);
const image = logo(8);
const key = JSON.stringify(await createKey({ width: 8, height: 8 }));

function workspace(t, files = {}) {
  const folder = temporaryFolder(t);
  const all = { 'in.ply': ply, 'key.json': key, 'logo.png': logoPng(image), ...files };
  for (const [name, bytes] of Object.entries(all)) {
    mkdirSync(join(folder, name, '..'), { recursive: true });
    writeFileSync(join(folder, name), bytes);
  }
  const list = () => readdirSync(folder, { recursive: true }).sort();
  const before = list();
  /** Runs, and asserts status, the message on standard error, and that no file appeared or changed. */
  const refuses = async (args, status, message, options) => {
    const contents = Object.fromEntries(Object.keys(all).map((name) => [name, readFileSync(join(folder, name))]));
    const result = await quadmark(args, { cwd: folder, ...options });
    assert.equal(result.status, status, `${args.join(' ')}\n${result.stderr}`);
    assert.match(result.stderr, message);
    assert.doesNotMatch(result.stderr, /\n\s+at /, 'no stack trace');
    assert.deepEqual(list(), before, 'no file appeared');
    for (const [name, bytes] of Object.entries(contents)) {
      assert.equal(Buffer.compare(readFileSync(join(folder, name)), bytes), 0, `${name} is unchanged`);
    }
    return result;
  };
  return { folder, path: (name) => join(folder, name), refuses, before, list };
}

const EMBED = ['--key', 'key.json', '--image', 'logo.png'];

test('usage mistakes are exit 2', async (t) => {
  const { refuses } = workspace(t);
  await refuses([], 2, /Usage/);
  await refuses(['paint'], 2, /unknown command/);
  await refuses(['embed', 'in.ply', 'out.ply', '--bogus'], 2, /unknown option/);
  await refuses(['embed', 'in.ply', ...EMBED], 2, /expected IN and OUT/);
  await refuses(['embed', 'in.ply', 'out.ply', '--image', 'logo.png'], 2, /no key.*QUADMARK_KEY_FILE/);
  await refuses(['embed', 'in.ply', 'out.ply', '--key', 'key.json'], 2, /exactly one of --image, --id, --text and --recipients/);
  await refuses(['embed', 'in.ply', 'out.ply', ...EMBED, '--id', '1'], 2, /exactly one of --image, --id, --text and --recipients/);
  await refuses(['embed', 'in.ply', 'out.ply', ...EMBED, '--set', 'lambda'], 2, /NAME=VALUE/);
  await refuses(['embed', 'in.ply', 'out.ply', ...EMBED, '--set', 'strength=1'], 2, /strength: unknown parameter/);
  await refuses(['embed', 'in.ply', 'out.ply', ...EMBED, '--set', 'H1=40'], 2, /H1/);
  await refuses(['embed', 'in.ply', '-', ...EMBED, '--json'], 2, /both want standard output/);
  await refuses(['embed', 'in.ply', 'out.glb', ...EMBED], 2, /out\.glb: marking does not convert/);
  await refuses(['embed', '-', 'out.ply', '--key', '-', '--image', 'logo.png'], 2, /only once/);
  await refuses(['extract', '--key', 'key.json'], 2, /missing required argument/);
  await refuses(['keygen', 'new.json', '--scheme', 'paper'], 2, /exactly one of --image, --size and --id-bits/);
  await refuses(['keygen', 'new.json', '-L', '3'], 2, /exactly one of --image, --size and --id-bits/);
  await refuses(['keygen', 'new.json', '--size', '24'], 2, /WIDTHxHEIGHT/);
  await refuses(['keygen', 'new.json', '--id-bits', '32'], 2, /only 64/);
  await refuses(['keygen', 'new.json', '--size', '24x24', '--scheme', 'sturdy'], 2, /Allowed choices are robust, paper/);
  await refuses(['attack', 'in.ply', 'out.ply'], 2, /--kind/);
  await refuses(['attack', 'in.ply', 'out.ply', '--kind', 'paint'], 2, /paint/);
  await refuses(['attack', 'in.ply', 'out.obj', '--kind', 'reorder'], 2, /\.ply or \.glb/);
});

test('what cannot be read is exit 1 with the reason', async (t) => {
  const { refuses } = workspace(t, { 'empty.ply': '', 'cut.ply': ply.subarray(0, ply.length - 9), 'text.ply': 'hello' });
  await refuses(['embed', 'absent.ply', 'out.ply', ...EMBED], 1, /absent\.ply: no such file/);
  await refuses(['embed', '.', 'out.ply', ...EMBED], 1, /is a directory/);
  await refuses(['embed', 'empty.ply', 'out.ply', ...EMBED], 1, /bad_file/);
  await refuses(['embed', 'cut.ply', 'out.ply', ...EMBED], 1, /bad_file/);
  await refuses(['extract', 'text.ply', '--key', 'key.json', '--image-out', 'mark.png'], 1, /bad_file/);
  await refuses(['embed', 'in.ply', 'out.ply', '--key', 'absent.json', '--image', 'logo.png'], 1, /cannot read the key absent\.json/);
  await refuses(['embed', 'in.ply', 'out.ply', '--key', 'in.ply', '--image', 'logo.png'], 1, /in\.ply: .*bad_key/);
  await refuses(['embed', 'in.ply', 'out.ply', '--key', 'key.json', '--image', 'text.ply'], 1, /in\.ply: text\.ply: .*bad_image/);
  await refuses(['extract', '*.nothing', '--key', 'key.json'], 1, /no file matches/);
});

test('a key of another scheme or version is refused', async (t) => {
  const change = (part) => JSON.stringify({ ...JSON.parse(key), ...part });
  const { refuses } = workspace(t, { 'sturdy.json': change({ scheme: 'sturdy' }), 'new.json': change({ quadmark: 9 }) });
  await refuses(['embed', 'in.ply', 'out.ply', '--key', 'sturdy.json', '--image', 'logo.png'], 1, /sturdy.*bad_key/);
  await refuses(['embed', 'in.ply', 'out.ply', '--key', 'new.json', '--image', 'logo.png'], 1, /unsupported_version/);
  await refuses(['embed', 'in.ply', 'out.ply', ...EMBED, '--scheme', 'robust'], 1, /key is for scheme "paper"/);
});

test('nothing is overwritten without --force', async (t) => {
  const { refuses, path, folder } = workspace(t, { 'there.ply': 'precious' });
  await refuses(['embed', 'in.ply', 'there.ply', ...EMBED], 1, /already exists \(--force overwrites\)/);
  await refuses(['attack', 'in.ply', 'there.ply', '--kind', 'reorder'], 1, /already exists/);
  await refuses(['extract', 'in.ply', '--key', 'key.json', '--image-out', 'there.ply'], 1, /already exists/);
  await refuses(['keygen', 'key.json', '--size', '8x8'], 1, /already exists/);
  const forced = await quadmark(['embed', 'in.ply', 'there.ply', ...EMBED, '--force'], { cwd: folder });
  assert.equal(forced.status, 0, forced.stderr);
  assert.equal(readFileSync(path('there.ply')).length, ply.length);
});

test('an input is never overwritten, by whatever name, --force or not', async (t) => {
  const { folder, path } = workspace(t);
  symlinkSync('in.ply', path('link.ply'));
  linkSync(path('in.ply'), path('hard.ply'));
  mkdirSync(path('sub'));
  symlinkSync('..', path('sub/up'));
  const before = readFileSync(path('in.ply'));
  for (const out of ['in.ply', './in.ply', 'sub/../in.ply', 'link.ply', 'hard.ply', 'sub/up/in.ply']) {
    const { status, stderr } = await quadmark(['embed', 'in.ply', out, ...EMBED, '--force'], { cwd: folder });
    assert.equal(status, 1, out);
    assert.match(stderr, /it is the input/);
  }
  for (const out of ['key.json', 'logo.png']) {
    const { status, stderr } = await quadmark(['embed', 'in.ply', out, ...EMBED, '--force'], { cwd: folder });
    assert.equal(status, 1);
    assert.match(stderr, /it is the input/);
  }
  const { status } = await quadmark(['embed', 'link.ply', 'in.ply', ...EMBED, '--force'], { cwd: folder });
  assert.equal(status, 1);
  assert.equal(Buffer.compare(readFileSync(path('in.ply')), before), 0);
});

test('an output that cannot be written is a clear error, and nothing is left', async (t) => {
  const { folder, path, refuses } = workspace(t, { 'dir/x': '' });
  await refuses(['embed', 'in.ply', 'absent/out.ply', ...EMBED], 1, /absent is not a directory/);
  await refuses(['embed', 'in.ply', 'dir', ...EMBED], 1, /is a directory/);
  await refuses(['embed', 'in.ply', 'key.json/out.ply', ...EMBED], 1, /not a directory/);
  await refuses(['embed', 'in.ply', '/dev/null', ...EMBED, '--force'], 1, /not a regular file/);
  await refuses(['embed', 'in.ply', '/proc/quadmark.ply', ...EMBED], 1, /cannot write \/proc\/quadmark\.ply/);
  if (process.getuid?.() === 0) {
    t.diagnostic('running as root, who may write anywhere: the read-only folder was not tested');
    return;
  }
  mkdirSync(path('locked'));
  chmodSync(path('locked'), 0o555);
  const { status, stderr } = await quadmark(['embed', 'in.ply', 'locked/out.ply', ...EMBED], { cwd: folder });
  assert.equal(status, 1);
  assert.match(stderr, /permission denied/);
});

test('buffers outside the folder of a glTF are not followed', async (t) => {
  const glb = await sculpture('glb', 1500);
  const cases = ['../secret.bin', '/etc/passwd', 'a/../../secret.bin', '%2e%2e/secret.bin', 'http://127.0.0.1:1/x.bin',
    'file:///etc/passwd', '..%5Csecret.bin', 'C:%5Cx.bin'];
  const files = { 'secret.bin': splitGlb(glb, 'x').bin };
  cases.forEach((uri, i) => { files[`m/${i}.gltf`] = splitGlb(glb, uri).gltf; });
  const { refuses } = workspace(t, files);
  for (let i = 0; i < cases.length; ++i) {
    await refuses(['embed', `m/${i}.gltf`, 'out.gltf', ...EMBED], 1, /only files beside or below the glTF are read.*unsupported_file/);
  }
  await refuses(['inspect', '-'], 2, /on standard input/, { input: splitGlb(glb, 'a.bin').gltf });
});

test('marked buffers never replace the input\'s, nor those of another model', async (t) => {
  const { gltf, bin } = splitGlb(await sculpture('glb', 1500), 'mesh.bin');
  const { refuses, folder, path } = workspace(t, { 'a/m.gltf': gltf, 'a/mesh.bin': bin, 'b/n.gltf': gltf, 'b/mesh.bin': bin, 'out/keep': '' });
  await refuses(['embed', 'a/m.gltf', 'a/marked.gltf', ...EMBED], 1, /would overwrite the input's: write to another directory/);
  await refuses(['embed', 'a/m.gltf', 'a/marked.gltf', ...EMBED, '--force'], 1, /would overwrite the input's/);
  await refuses(['embed', 'a/m.gltf', '-', ...EMBED], 2, /external buffer "mesh\.bin"/);
  await refuses(['embed', 'a/absent.gltf', 'out/m.gltf', ...EMBED], 1, /no such file/);
  const both = await quadmark(['embed', 'a/m.gltf', 'b/n.gltf', '--out-dir', 'out', ...EMBED, '--force', '--json'], { cwd: folder });
  assert.equal(both.status, 1);
  assert.match(both.json[1].error.message, /a\/m\.gltf of the same run goes there too/);
  assert.deepEqual(readdirSync(path('out')).sort(), ['keep', 'm.gltf', 'mesh.bin']);
});

test('--json reports failures as one object too', async (t) => {
  const { refuses } = workspace(t, { 'empty.ply': '' });
  const { stdout } = await refuses(['embed', 'empty.ply', 'out.ply', ...EMBED, '--json'], 1, /bad_file/);
  const report = JSON.parse(stdout);
  assert.deepEqual([report.command, report.input, report.error.code], ['embed', 'empty.ply', 'bad_file']);
  assert.ok(report.error.message.length > 5);
});

test('a payload too large for the model is exit 1 with the numbers', async (t) => {
  const big = JSON.stringify(await createKey({ width: 200, height: 200 }));
  const { refuses } = workspace(t, { 'big.json': big, 'big.png': logoPng(logo(200)) });
  await refuses(['embed', 'in.ply', 'out.ply', '--key', 'big.json', '--image', 'big.png'], 1, /40000.*capacity/);
});
