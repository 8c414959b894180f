// SPDX-License-Identifier: MIT
// The package's calls under keys of scheme `robust`.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { createKey, embed, extract, inspect, parseKey, QuadmarkError } from 'quadmark';
import { attack } from 'quadmark/lab';
import { logo, packBits, sculpture } from './support/marks.mjs';

const key = { ...(await createKey({ owner: 'the tests' })), secret: Buffer.alloc(32, 'for tests').toString('base64') };
const model = await sculpture('glb', 9000);
const marked = await embed(model, { key, id: 'c0ffee' });
const fails = (promise, code, message) =>
  assert.rejects(promise, (error) => error instanceof QuadmarkError && error.code === code && message.test(error.message));

test('a key has an owner and a secret, and nothing else to choose', async () => {
  assert.deepEqual(Object.keys(key).sort(), ['owner', 'quadmark', 'scheme', 'secret']);
  assert.deepEqual(await parseKey(JSON.stringify(key)), key);
  await fails(createKey({ scheme: 'robust', width: 24, height: 24 }), 'bad_option', /unknown member "width"/);
});

test('an ID comes back with nothing but file and key', async () => {
  const read = await extract(marked.bytes, { key });
  assert.equal(read.verdict, 'match');
  assert.equal(read.id, '0000000000c0ffee');
  assert.equal(read.text, null);
  assert.equal(read.image, null);
  assert.ok(read.falsePositive < 1e-30, String(read.falsePositive));
  assert.ok(read.evidence.length > 8000);
  assert.ok(read.evidence.reduce((sum, value) => sum + value, 0) > 350, 'votes agree with the mark');
  assert.deepEqual([read.report.scheme, read.report.payload, read.report.id], ['robust', 'id', '0000000000c0ffee']);
  assert.ok(read.report.cells > 1000);
  assert.equal((await extract(model, { key })).verdict, 'none');
  assert.equal((await extract(marked.bytes, { key: await createKey({ scheme: 'robust' }) })).verdict, 'none');
});

test('it survives what web builds do to positions', async () => {
  for (const request of [
    { kind: 'quantize', amount: 14, variant: 'common' }, { kind: 'quantize', amount: 12, variant: 'common' },
    { kind: 'noise', amount: 1e-4 }, { kind: 'affine', variant: 'CB' }, { kind: 'reorder', seed: 3 },
    { kind: 'crop', amount: 0.5 }, { kind: 'simplify', amount: 0.1, variant: 'meshopt' },
  ]) {
    const { bytes } = await attack(marked.bytes, request);
    const read = await extract(bytes, { key });
    assert.equal(read.id, '0000000000c0ffee', JSON.stringify(request));
    assert.equal(read.verdict, 'match');
  }
});

test('the embed report has the documented members', () => {
  const { report } = marked;
  assert.deepEqual([report.scheme, report.payload, report.strength, report.payloadBits], ['robust', 'id', 'standard', 92]);
  assert.ok(['basic', 'standard', 'full'].includes(report.capacityClass));
  assert.ok(report.repeats > 2);
  assert.equal(report.cells, report.ring.carriers + report.diamonds.cells);
  assert.equal(report.verified.unattacked, true);
  assert.equal(report.selfTest, undefined);
  for (const name of ['snrDb', 'rmsRel', 'maxRel', 'hausdorffRel', 'normalPsnrDb', 'meanNormalDeg']) {
    assert.equal(typeof report.distortion[name], 'number', name);
  }
});

test('an expected ID is confirmed or denied', async () => {
  const same = await extract(marked.bytes, { key, expectId: 0xc0ffeen });
  assert.deepEqual([same.verdict, same.report.expected.comparison], ['match', 'agrees']);
  const other = await extract(marked.bytes, { key, expectId: 'c0ffef' });
  assert.deepEqual([other.verdict, other.report.expected.comparison, other.id], ['none', 'differs', '0000000000c0ffee']);
});

test('texts come back, long ones too', async () => {
  for (const text of ['Stuhl 42', 'Beispielstudio, Stühle & Tische 42']) {
    const { bytes } = await embed(model, { key, text });
    const read = await extract(bytes, { key, expectText: text });
    assert.deepEqual([read.verdict, read.text, read.id, read.report.payload], ['match', text, null, 'text']);
  }
});

test('an image comes back with confidence, without its size in the key', async () => {
  const image = logo(16, 12);
  const { bytes } = await embed(model, { key, image });
  const read = await extract(bytes, { key, reference: image });
  assert.deepEqual([read.image.width, read.image.height], [16, 12]);
  assert.deepEqual(read.image.bits, image.bits);
  assert.ok(read.image.confidence.every((value) => value > 0.99));
  assert.deepEqual([read.report.ber, read.report.exact, read.report.image.bits], [0, true, packBits(image)]);
});

test('salts separate assets', async () => {
  const { bytes } = await embed(model, { key, id: '7', options: { salt: 'chair' } });
  assert.equal((await extract(bytes, { key, options: { salt: 'chair' } })).id, '0000000000000007');
  assert.equal((await extract(bytes, { key })).verdict, 'none');
});

test('strength trades distortion, a cap is kept, and a self-test says what it buys', async () => {
  const rms = [];
  for (const strength of ['invisible', 'standard', 'strong']) {
    const { report } = await embed(model, { key, id: '1', options: { strength, selfTest: strength === 'strong' } });
    assert.equal(report.strength, strength);
    rms.push(report.distortion.rmsRel);
    if (report.selfTest) {
      assert.deepEqual(Object.keys(report.selfTest), ['quantize14', 'quantize11', 'noise3e-4', 'collapse10', 'collapse10quantize14', 'crop50']);
      assert.equal(report.selfTest.quantize14.read, true);
    }
  }
  assert.ok(rms[0] <= rms[1] && rms[1] < rms[2], rms.join(' '));
  const capped = await embed(model, { key, id: '1', options: { maxError: 1e-3 } });
  assert.ok(capped.report.distortion.maxRel <= 1.001e-3, String(capped.report.distortion.maxRel));
});

test('inspect counts the places for a mark', async () => {
  const { robust } = await inspect(model);
  assert.ok(robust.carriers > 100 && robust.labels <= robust.carriers && robust.diamonds > 1000, JSON.stringify(robust));
});

test('wrong use is refused', async () => {
  const paper = await createKey({ width: 24, height: 24 });
  await fails(embed(model, { key, id: '1', options: { strength: 'weak' } }), 'bad_option', /strength: expected "invisible"/);
  await fails(embed(model, { key, id: '1', options: { maxError: 'a' } }), 'bad_option', /maxError/);
  await fails(embed(model, { key, id: '1', options: { selfTest: 1 } }), 'bad_option', /selfTest/);
  await fails(embed(model, { key, id: '1', options: { salt: 7 } }), 'bad_option', /salt/);
  await fails(embed(model, { key, text: '' }), 'bad_option', /text: 0 bytes/);
  await fails(embed(model, { key, text: '\ud800' }), 'bad_option', /well-formed/);
  await fails(embed(model, { key, text: 'x'.repeat(65) }), 'bad_option', /65 bytes/);
  await fails(embed(model, { key, image: { width: 200, height: 1, bits: new Uint8Array(200) } }), 'bad_image', /200 x 1/);
  await fails(embed(model, { key: paper, text: 'x' }), 'bad_key', /no text/);
  await fails(embed(model, { key: paper, image: logo(), options: { strength: 'strong' } }), 'bad_option', /only with a key of scheme "robust"/);
  await fails(extract(model, { key: paper, expectId: '1' }), 'bad_key', /reference/);
  await fails(extract(model, { key, expectId: '1', expectText: 'x' }), 'bad_option', /at most one/);
  await fails(embed(await sculpture('ply', 500), { key, image: logo(90) }), 'capacity', /bits/);
});
