// SPDX-License-Identifier: MIT
// The command line under keys of scheme `robust`.
import assert from 'node:assert/strict';
import { existsSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { quadmark, temporaryFolder } from './support/files.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';

const ply = await sculpture('ply', 9000);

async function workspace(t) {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, 'in.ply'), ply);
  writeFileSync(join(folder, 'logo.png'), logoPng(logo(12)));
  const cli = (...args) => quadmark(args, { cwd: folder });
  const made = await cli('keygen', 'key.json', '--owner', 'the tests');
  assert.equal(made.status, 0, made.stderr);
  assert.match(made.stdout.toString(), /scheme robust/);
  return { cli, exists: (name) => existsSync(join(folder, name)) };
}

test('an ID is marked, read and asked for', async (t) => {
  const { cli } = await workspace(t);
  const embedded = await cli('embed', 'in.ply', 'out.ply', '--key', 'key.json', '--id', 'C0FFEE', '--strength', 'strong', '--self-test');
  assert.equal(embedded.status, 0, embedded.stderr);
  assert.match(embedded.stdout.toString(), /id at strength strong, capacity/);
  assert.match(embedded.stdout.toString(), /after quantize14: read/);
  const read = await cli('extract', 'out.ply', '--key', 'key.json');
  assert.equal(read.status, 0, read.stderr);
  assert.match(read.stdout.toString(), /ID 0000000000c0ffee/);
  assert.equal((await cli('extract', 'out.ply', '--key', 'key.json', '--expect-id', 'c0ffee')).status, 0);
  const other = await cli('extract', 'out.ply', '--key', 'key.json', '--expect-id', '1');
  assert.equal(other.status, 3);
  assert.match(other.stdout.toString(), /none \(a mark of this key, but another one\)/);
  assert.equal((await cli('extract', 'in.ply', '--key', 'key.json')).status, 3);
});

test('a text and its salt go in and come out', async (t) => {
  const { cli } = await workspace(t);
  const embedded = await cli('embed', 'in.ply', 'out.ply', '--key', 'key.json', '--text', 'chair 42', '--salt', 'a', '--max-error', '0.002', '--json');
  assert.equal(embedded.status, 0, embedded.stderr);
  assert.equal(embedded.json[0].payload, 'text');
  assert.ok(embedded.json[0].distortion.maxRel <= 0.00201);
  const read = await cli('extract', 'out.ply', '--key', 'key.json', '--salt', 'a', '--expect-text', 'chair 42', '--json');
  assert.deepEqual([read.status, read.json[0].text, read.json[0].expected.comparison], [0, 'chair 42', 'agrees']);
  assert.equal((await cli('extract', 'out.ply', '--key', 'key.json')).status, 3);
});

test('an image is written where there is one', async (t) => {
  const { cli, exists } = await workspace(t);
  assert.equal((await cli('embed', 'in.ply', 'out.ply', '--key', 'key.json', '--image', 'logo.png')).status, 0);
  const read = await cli('extract', 'out.ply', '--key', 'key.json', '--image-out', 'mark.png', '--reference', 'logo.png', '--json');
  assert.deepEqual([read.status, read.json[0].ber, exists('mark.png')], [0, 0, true]);
  const none = await cli('extract', 'in.ply', '--key', 'key.json', '--image-out', 'none.png');
  assert.deepEqual([none.status, exists('none.png')], [3, false]);
  assert.match(none.stderr.toString(), /no image was found/);
});

test('options that only keys of scheme paper know make such a key, and say so', async (t) => {
  const { cli } = await workspace(t);
  const made = await cli('keygen', 'sized.json', '--size', '24x24', '--json');
  assert.deepEqual([made.status, made.json[0].scheme, made.json[0].params.width], [0, 'paper', 24]);
  assert.match(made.json[0].warnings[0], /--size makes this a key of scheme paper/);
  assert.match(made.stderr.toString(), /without it the key is of scheme robust/);
  const asked = await cli('keygen', 'asked.json', '--scheme', 'paper', '--size', '24x24', '--json');
  assert.deepEqual([asked.json[0].scheme, asked.json[0].warnings], ['paper', []]);
});

test('wrong use is exit 2, with the reason', async (t) => {
  const { cli } = await workspace(t);
  const refuses = async (args, message) => {
    const { status, stderr } = await cli(...args);
    assert.equal(status, 2, args.join(' '));
    assert.match(stderr.toString(), message);
  };
  await refuses(['keygen', 'other.json', '--scheme', 'robust', '--size', '24x24'], /--size does not go with --scheme robust/);
  const EMBED = ['embed', 'in.ply', 'out.ply', '--key', 'key.json'];
  await refuses([...EMBED, '--id', '1', '--text', 'x'], /exactly one/);
  await refuses([...EMBED, '--id', '1', '--strength', 'weak'], /strength/);
  await refuses([...EMBED, '--id', '1', '--set', 'H1=3'], /--set does not go with a key of scheme robust/);
  await refuses(['extract', 'in.ply', '--key', 'key.json', '--expect-id', 'xyz'], /expectId/);
});
