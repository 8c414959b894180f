// SPDX-License-Identifier: MIT
// The package's public calls on good input.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { createKey, decodeImage, embed, encodeImage, externalUris, extract, inspect, parseKey, version } from 'quadmark';
import { attack } from 'quadmark/lab';
import { splitGlb } from './support/gltf.mjs';
import { logo, logoPng, packBits, sculpture } from './support/marks.mjs';
import { readPng } from './support/png.mjs';

const image = logo();
const same = (a, b) => Buffer.compare(Buffer.from(a), Buffer.from(b)) === 0;

test('embed and extract return the image exactly', async () => {
  const key = await createKey({ owner: 'test', width: 24, height: 24 });
  for (const format of ['ply', 'glb']) {
    const model = await sculpture(format);
    const marked = await embed(model, { key, image });
    assert.equal(marked.bytes.length >= model.length - 400, true);
    assert.equal(same(marked.bytes, model), false);
    assert.deepEqual(marked.resources, {});
    const read = await extract(marked.bytes, { key });
    assert.equal(read.verdict, 'match', format);
    assert.ok(read.falsePositive < 1e-9, `falsePositive ${read.falsePositive}`);
    assert.deepEqual([read.image.width, read.image.height], [24, 24]);
    assert.deepEqual(read.image.bits, image.bits);
    assert.ok(read.image.erased.every((value) => value === 0));
    assert.equal(read.id, null);
  }
});

test('the embed report has the documented members', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const model = await sculpture();
  const { bytes, report } = await embed(model, { key, image });
  assert.equal(report.scheme, 'paper');
  assert.equal(report.payloadBits, 576);
  assert.ok(report.cells > 96 && Number.isInteger(report.cells));
  assert.ok(report.capacityBits >= 576);
  assert.ok(Array.isArray(report.warnings));
  for (const name of ['snrDb', 'rmsRel', 'maxRel', 'hausdorffRel', 'normalPsnrDb', 'meanNormalDeg']) {
    assert.equal(typeof report.distortion[name], 'number', name);
  }
  assert.ok(report.distortion.snrDb > 40);
  let changed = 0;
  for (let i = 0; i < bytes.length; ++i) changed += bytes[i] !== model[i] ? 1 : 0;
  assert.equal(report.bytesChanged, changed);
});

test('the extract report agrees with the result beside it', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const { bytes } = await embed(await sculpture(), { key, image });
  const { report, ...result } = await extract(bytes, { key, reference: image });
  assert.equal(report.scheme, 'paper');
  assert.equal(report.verdict, result.verdict);
  assert.equal(report.falsePositive, result.falsePositive);
  assert.equal(report.image.width, 24);
  assert.equal(report.image.height, 24);
  assert.equal(report.image.bits, packBits(image));
  assert.equal(report.ber, 0);
  assert.ok(Array.isArray(report.perNode));
  assert.ok(report.cells > 0);
});

test('the pictures show ink black, light white and confidence as grey', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const { bytes } = await embed(await sculpture(), { key, image });
  const { image: read } = await extract(bytes, { key });
  const picture = readPng(read.png);
  assert.deepEqual([picture.width, picture.height], [24, 24]);
  assert.deepEqual(Uint8Array.from(picture.levels, (level) => (level < 128 ? 1 : 0)), image.bits);
  const confidence = readPng(read.confidencePng);
  read.confidence.forEach((value, i) => {
    assert.ok(value >= 0 && value <= 1);
    assert.ok(Math.abs(confidence.levels[i] - value * 255) <= 1, `pixel ${i}`);
  });
});

test('an image is taken as PNG, as typed array and as plain array alike', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const model = await sculpture();
  const inputs = [image, { ...image, bits: [...image.bits] }, logoPng(image), new Uint8Array(logoPng(image)).buffer];
  const outputs = await Promise.all(inputs.map((input) => embed(model, { key, image: input })));
  for (const output of outputs) assert.ok(same(output.bytes, outputs[0].bytes));
});

test('a key is taken as object, text and bytes alike', async () => {
  const key = await createKey({ owner: 'Zoë & Co', width: 24, height: 24 });
  assert.equal(key.owner, 'Zoë & Co');
  const text = JSON.stringify(key);
  const model = await sculpture();
  const outputs = await Promise.all([key, text, Buffer.from(text)].map((form) => embed(model, { key: form, image })));
  for (const output of outputs) assert.ok(same(output.bytes, outputs[0].bytes));
  assert.deepEqual(await parseKey(text), key);
  assert.deepEqual(await parseKey(key), key);
});

test('createKey draws a new secret each time and chooses digits for the payload', async () => {
  const [a, b] = await Promise.all([createKey({ width: 24, height: 24 }), createKey({ width: 90, height: 90, L: 3 })]);
  assert.notEqual(a.secret, b.secret);
  assert.equal(Buffer.from(a.secret, 'base64').length, 32);
  const digits = ({ params: { L1, H1, L2, H2 } }) => [L1, H1, L2, H2];
  assert.deepEqual(digits(a), [2, 3, 2, 3]);
  assert.deepEqual(digits(b), [3, 5, 3, 5]);
  const c = await createKey({ width: 8, height: 8, H1: 4, L1: 3, H2: 5, L2: 2, k: 2, lambda: 2e-3, tau: 5e-4, keyedCells: true });
  assert.deepEqual(digits(c), [3, 4, 2, 5]);
  assert.deepEqual([c.params.k, c.params.lambda, c.params.tau, c.params.keyedCells], [2, 2e-3, 5e-4, true]);
});

test('a 64-bit ID comes back in hexadecimal', async () => {
  const key = await createKey({ id: true });
  const model = await sculpture();
  for (const [id, expected] of [['C0FFEE', '0000000000c0ffee'], [0xfedcba9876543210n, 'fedcba9876543210'], ['0', '0000000000000000']]) {
    const { bytes } = await embed(model, { key, id });
    const read = await extract(bytes, { key });
    assert.equal(read.verdict, 'match', expected);
    assert.equal(read.id, expected);
  }
});

test('another key and an unmarked model read as "none"', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const model = await sculpture();
  const { bytes } = await embed(model, { key, image });
  const other = await extract(bytes, { key: await createKey({ width: 24, height: 24 }) });
  assert.equal(other.verdict, 'none');
  assert.ok(other.falsePositive > 1e-6);
  const unmarked = await extract(model, { key });
  assert.equal(unmarked.verdict, 'none');
  assert.equal(unmarked.id, null);
});

test('the mark survives affine maps, reordering and renaming of the format', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const { bytes } = await embed(await sculpture(), { key, image });
  const attacks = [
    { kind: 'affine', variant: 'CB' }, { kind: 'reorder', seed: 7 }, { kind: 'reorder', seed: 8, format: 'glb' },
  ];
  for (const request of attacks) {
    const attacked = await attack(bytes, request);
    const read = await extract(attacked.bytes, { key });
    assert.equal(read.verdict, 'match', JSON.stringify(request));
    assert.deepEqual(read.image.bits, image.bits, JSON.stringify(request));
  }
});

test('external buffers come from resources and go back there', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const { gltf, bin } = splitGlb(await sculpture('glb'), 'mesh%20data.bin');
  assert.deepEqual(await externalUris(gltf), ['mesh%20data.bin']);
  const given = { 'mesh%20data.bin': bin };
  const marked = await embed(gltf, { key, image, resources: given });
  assert.deepEqual(Object.keys(marked.resources), ['mesh%20data.bin']);
  assert.equal(marked.resources['mesh%20data.bin'].length, bin.length);
  const read = await extract(marked.bytes, { key, resources: new Map(Object.entries(marked.resources)) });
  assert.deepEqual(read.image.bits, image.bits);
  assert.equal((await extract(gltf, { key, resources: given })).verdict, 'none');
});

test('inspect describes a model without a key', async () => {
  const report = await inspect(await sculpture('glb'));
  assert.equal(report.format, 'glb');
  assert.ok(report.vertices >= 5000 && report.vertices <= 7000, `${report.vertices} vertices`);
  assert.ok(Array.isArray(report.warnings));
});

test('progress runs from stage to stage up to the end', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const seen = [];
  const model = await sculpture();
  const { bytes } = await embed(model, { key, image, options: { onProgress: (progress) => seen.push(progress) } });
  assert.ok(seen.length >= 3);
  for (const { stage, done } of seen) {
    assert.ok(['read', 'search', 'write', 'verify', 'report'].includes(stage), stage);
    assert.ok(done >= 0 && done <= 1);
  }
  for (let i = 1; i < seen.length; ++i) assert.ok(seen[i].done >= seen[i - 1].done, 'share done never falls');
  const reading = [];
  await extract(bytes, { key, options: { onProgress: ({ stage }) => reading.push(stage) } });
  assert.ok(reading.length >= 1);
});

test('results share no memory with the module or with each other', async () => {
  const key = await createKey({ width: 24, height: 24 });
  const model = await sculpture();
  const before = Uint8Array.from(model);
  const first = await embed(model, { key, image });
  const copy = Uint8Array.from(first.bytes);
  await embed(model, { key, image: { ...image, bits: image.bits.map((bit) => 1 - bit) } });
  assert.ok(same(first.bytes, copy));
  assert.ok(same(model, before), 'the input is left alone');
  assert.equal(first.bytes.buffer.byteLength, first.bytes.length);
});

test('images convert both ways', async () => {
  const wide = logo(13, 7);
  assert.deepEqual(await decodeImage(logoPng(wide)), wide);
  const png = await encodeImage({ ...wide, erased: wide.bits.map((bit, i) => (i === 5 ? 1 : 0)) });
  const { levels } = readPng(png);
  assert.equal(levels[5], 128);
  assert.ok(levels.every((level, i) => i === 5 || level === (wide.bits[i] ? 0 : 255)));
});

test('the version is the package\'s', async () => {
  const { default: manifest } = await import('quadmark/package.json', { with: { type: 'json' } });
  assert.equal(await version(), manifest.version);
});
