// SPDX-License-Identifier: MIT
// Bad input: each case fails with its exact code and a message that names the place.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as quadmark from 'quadmark';
import { ERROR_EXIT_STATUS, QuadmarkError, createKey, embed, extract, inspect, parseKey } from 'quadmark';
import { attack, generate } from 'quadmark/lab';
import factory from '../node/dist/quadmark.js';
import { Loader } from '../node/src/load.js';
import { readFile } from 'node:fs/promises';
import { openGltf, splitGlb } from './support/gltf.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';
import { writePng } from './support/png.mjs';

const image = logo();
const key = await createKey({ width: 24, height: 24 });
const idKey = await createKey({ id: true });
const ply = await sculpture('ply', 2000);
const glb = await sculpture('glb', 2000);

/** Asserts the code, that the message matches, and that it is one plain sentence without final stop. */
async function fails(promise, code, message) {
  await assert.rejects(promise, (error) => {
    assert.ok(error instanceof QuadmarkError, String(error.stack));
    assert.equal(error.code, code, error.message);
    assert.match(error.message, message);
    assert.doesNotMatch(error.message, /\n|\.$/);
    return true;
  });
}

test('the error codes are those of the core', async () => {
  const loader = new Loader(factory, () => readFile(new URL('../node/dist/quadmark.wasm', import.meta.url)));
  const codes = await loader.call((api) => api.errorCodes());
  assert.deepEqual(Object.keys(ERROR_EXIT_STATUS), codes);
  for (const status of Object.values(ERROR_EXIT_STATUS)) assert.ok(status === 1 || status === 2);
});

test('files that are no models are refused', async () => {
  const cases = {
    empty: new Uint8Array(0),
    'wrong magic': Buffer.from('Kaydara FBX Binary  \0'),
    'GLB magic alone': Buffer.from('glTF'),
    'PLY magic alone': Buffer.from('ply\n'),
    'JSON that is no glTF': Buffer.from('{"hello": 1}'),
    'broken JSON': Buffer.from('{"asset": {"version": "2.0"'),
    'an image': logoPng(image),
  };
  for (const [name, bytes] of Object.entries(cases)) {
    for (const call of [embed(bytes, { key, image }), extract(bytes, { key }), inspect(bytes)]) {
      await assert.rejects(call, { name: 'QuadmarkError', code: 'bad_file' }, name);
    }
  }
});

test('truncated files are refused', async () => {
  for (const model of [ply, glb]) {
    for (const length of [5, 11, 19, 60, 300, model.length >> 1, model.length - 1]) {
      await assert.rejects(inspect(model.subarray(0, length)), { code: 'bad_file' }, `first ${length} bytes`);
    }
  }
});

test('counts that lie are refused before anything is allocated', async () => {
  const header = (vertices, faces) => Buffer.from(`ply\nformat binary_little_endian 1.0\nelement vertex ${vertices}
property float x\nproperty float y\nproperty float z\nelement face ${faces}
property list uchar int vertex_indices\nend_header\n`);
  await inspect(glb);
  const held = quadmark.memoryBytes();
  for (const [vertices, faces] of [[4294967295, 1], [1e15, 1], [0, 4294967295], [357913942, 1], ['99999999999999999999999', 1]]) {
    await fails(inspect(Buffer.concat([header(vertices, faces), Buffer.alloc(64)])), 'bad_file', /vertex|face|element|line/);
  }
  const { json, bin } = openGltf(glb);
  const lie = (change) => {
    const copy = structuredClone(json);
    change(copy);
    copy.buffers[0].uri = 'b.bin';
    return inspect(Buffer.from(JSON.stringify(copy)), { resources: { 'b.bin': bin } });
  };
  const position = json.meshes[0].primitives[0].attributes.POSITION;
  await fails(lie((copy) => { copy.accessors[position].count = 4294967295; }), 'bad_file', /accessor/);
  await fails(lie((copy) => { copy.accessors[position].byteOffset = 4294967292; }), 'bad_file', /accessor/);
  await fails(lie((copy) => { copy.bufferViews[0].byteLength = 1e15; }), 'bad_file', /bufferView/);
  await fails(lie((copy) => { copy.buffers[0].byteLength = 1e9; }), 'bad_file', /buffer/);
  await fails(lie((copy) => { copy.meshes[0].primitives[0].attributes.POSITION = 99; }), 'bad_file', /accessor|99/);
  assert.equal(quadmark.memoryBytes(), held, 'the module did not grow');
});

test('positions that are no numbers are refused with the vertex', async () => {
  const text = (x) => Buffer.from(`ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y
property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header
0 0 0\n1 0 0\n1 ${x} 0\n0 1 0.5\n3 0 1 2\n3 0 2 3\n`);
  for (const x of ['nan', 'inf', '-inf', '1e99']) await fails(inspect(text(x)), 'bad_mesh', /vertex 2/);
  await fails(inspect(text('abc')), 'bad_file', /line|vertex 2/);
});

test('models without triangles are refused', async () => {
  const points = Buffer.from('ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n');
  await fails(embed(points, { key, image }), 'bad_mesh', /face|triangle|polygon/);
});

test('images of unusable size are refused', async () => {
  await fails(embed(ply, { key, image: { width: 1, height: 1, bits: [1] } }), 'bad_image', /1 x 1|single pixel/);
  await fails(embed(ply, { key, image: writePng(1, 1, [0]) }), 'bad_image', /1 x 1|single pixel/);
  await fails(embed(ply, { key, image: logo(25) }), 'bad_image', /25 x 25.*24 x 24|24 x 24.*25 x 25/);
  await fails(embed(ply, { key, image: Buffer.from('no picture') }), 'bad_image', /PNG/);
  await fails(embed(ply, { key, image: logoPng(image).subarray(0, 60) }), 'bad_image', /PNG/);
  await fails(embed(ply, { key, image: { width: 24, height: 24, bits: [1, 0] } }), 'bad_image', /2 values, expected 576/);
  await fails(embed(ply, { key, image: { width: 24, height: 24, bits: new Uint8Array(576).fill(2) } }), 'bad_image', /bits\[0\] is 2/);
  await fails(extract(ply, { key, reference: logo(25) }), 'bad_image', /25 x 25/);
  // A header that claims 60000 x 60000 pixels, refused without allocating them.
  const huge = writePng(2, 2, [0, 0, 0, 0], { width: 60000, height: 60000 });
  await fails(embed(ply, { key, image: huge }), 'too_large', /60000/);
  await fails(createKey({ width: 1025, height: 24 }), 'bad_option', /width.*1024/);
});

test('a payload that does not fit is refused with the numbers', async () => {
  const big = await createKey({ width: 200, height: 200 });
  await fails(embed(ply, { key: big, image: logo(200) }), 'capacity', /40000.*bits|bits.*40000/);
  const cube = (await generate({ name: 'cube' })).bytes;
  await fails(embed(cube, { key, image }), 'capacity', /576/);
});

test('keys that cannot be used are refused', async () => {
  const broken = (change) => {
    const copy = structuredClone(key);
    change(copy);
    return parseKey(copy);
  };
  await fails(parseKey('no JSON'), 'bad_key', /JSON/);
  await fails(parseKey(''), 'bad_key', /JSON/);
  await fails(parseKey('[]'), 'bad_key', /object/);
  await fails(parseKey(Buffer.from([0x7b, 0xff, 0x7d])), 'bad_key', /UTF-8/);
  await fails(parseKey(7), 'bad_key', /key/);
  await fails(broken((copy) => { copy.scheme = 'sturdy'; }), 'bad_key', /sturdy/);
  await fails(broken((copy) => { copy.quadmark = 2; }), 'unsupported_version', /2/);
  await fails(broken((copy) => { delete copy.secret; }), 'bad_key', /secret/);
  await fails(broken((copy) => { copy.secret = 'AAAA'; }), 'bad_key', /secret/);
  await fails(broken((copy) => { copy.params.H1 = 12; }), 'bad_key', /H1/);
  await fails(broken((copy) => { copy.params.width = '24'; }), 'bad_key', /width/);
  await fails(broken((copy) => { copy.params.lambda = -1; }), 'bad_key', /lambda/);
  await fails(embed(ply, { key: idKey, image }), 'bad_key', /ID|id/);
  await fails(embed(ply, { key, id: '1' }), 'bad_key', /image/);
});

test('wrong arguments are refused, misspelt ones too', async () => {
  await fails(embed(ply, { key }), 'bad_option', /exactly one of image, id and text/);
  await fails(embed(ply, { key, image, id: '1' }), 'bad_option', /exactly one/);
  await fails(embed('model.ply', { key, image }), 'bad_option', /model: expected a Uint8Array/);
  await fails(embed(ply, undefined), 'bad_option', /request/);
  await fails(embed(ply, { key, imgae: image, id: '1' }), 'bad_option', /unknown member "imgae"/);
  await fails(embed(ply, { key, image, options: { onprogress() {} } }), 'bad_option', /onprogress/);
  await fails(embed(ply, { key, image, options: { signal: {} } }), 'bad_option', /AbortSignal/);
  await fails(embed(ply, { key, image, resources: [ply] }), 'bad_option', /resources/);
  await fails(embed(ply, { key, image, resources: { 'a.bin': 'text' } }), 'bad_option', /resources\["a\.bin"\]/);
  for (const id of ['', 'xyz', '11112222333344445', -1n, 1n << 64n, 5]) {
    await fails(embed(ply, { key: idKey, id }), 'bad_option', /id: expected/);
  }
  await fails(createKey({ scheme: 'paper' }), 'bad_option', /width and height/);
  await fails(createKey({ L: 3 }), 'bad_option', /width and height/);
  await fails(createKey({ width: 24 }), 'bad_option', /height/);
  await fails(createKey({ width: 24, height: 24, id: true }), 'bad_option', /either/);
  await fails(createKey({ width: 24, height: 24, scheme: 'sturdy' }), 'bad_option', /"sturdy" is not available in this version/);
  await fails(createKey({ width: 24, height: 24, H1: 3 }), 'bad_option', /go together/);
  await fails(createKey({ width: 24, height: 24, L: 1 }), 'bad_option', /L: /);
  await fails(createKey({ width: 24, height: 24, lambda: NaN }), 'bad_option', /lambda/);
  await fails(createKey({ width: 24, height: 24, tau: 0.5 }), 'bad_option', /tau/);
});

test('a missing resource is named', async () => {
  const { gltf } = splitGlb(glb, 'mesh.bin');
  await fails(inspect(gltf), 'bad_file', /mesh\.bin/);
});

test('features that this version cannot mark are refused as such', async () => {
  const { json, bin } = openGltf(glb);
  json.buffers[0].uri = 'b.bin';
  const position = json.meshes[0].primitives[0].attributes.POSITION;
  const with_ = (change) => {
    const copy = structuredClone(json);
    change(copy, copy.meshes[0].primitives[0]);
    return inspect(Buffer.from(JSON.stringify(copy)), { resources: { 'b.bin': bin } });
  };
  await fails(with_((copy, primitive) => {
    copy.extensionsUsed = copy.extensionsRequired = ['KHR_draco_mesh_compression'];
    primitive.extensions = { KHR_draco_mesh_compression: { bufferView: 0, attributes: { POSITION: 0 } } };
  }), 'bad_file', /mesh 0 primitive 0: this is no Draco data/);
  await fails(with_((copy) => {
    copy.extensionsUsed = copy.extensionsRequired = ['EXT_meshopt_compression'];
    copy.bufferViews[copy.accessors[position].bufferView].extensions =
      { EXT_meshopt_compression: { buffer: 0, byteLength: 100, byteStride: 12, count: 10, mode: 'ATTRIBUTES' } };
  }), 'bad_file', /EXT_meshopt_compression decodes to 120 bytes/);
  await fails(with_((copy) => {
    copy.accessors[position].sparse = { count: 0, indices: { bufferView: 0, componentType: 5123 }, values: { bufferView: 0 } };
  }), 'bad_file', /sparse\.count is 0/);
});

test('a cancelled call fails with "aborted", before it starts and under way', async () => {
  const reason = new Error('the user left');
  await assert.rejects(
    embed(ply, { key, image, options: { signal: AbortSignal.abort(reason) } }),
    { code: 'aborted', cause: reason });
  for (const call of [embed, extract]) {
    const controller = new AbortController();
    let calls = 0;
    const request = { key, options: { signal: controller.signal, onProgress() { ++calls; controller.abort(reason); } } };
    if (call === embed) request.image = image;
    await assert.rejects(call(ply, request), { code: 'aborted', cause: reason });
    assert.equal(calls, 1, 'nothing is reported after the cancellation');
  }
});

test('an exception of the caller\'s onProgress arrives as it is, and the module lives on', async () => {
  await inspect(ply);
  const held = quadmark.memoryBytes();
  const mine = new TypeError('mine');
  await assert.rejects(embed(ply, { key, image, options: { onProgress() { throw mine; } } }), mine);
  assert.ok(quadmark.memoryBytes() >= held && held > 0);
  assert.equal((await extract((await embed(ply, { key, image })).bytes, { key })).verdict, 'match');
});

test('the lab refuses what it does not know', async () => {
  await fails(attack(ply, { kind: 'paint' }), 'bad_option', /paint/);
  await fails(attack(ply, { kind: 'affine', variant: 'XX' }), 'bad_option', /XX/);
  await fails(attack(ply, { kind: 'crop', amount: 0.5, format: 'obj' }), 'bad_option', /format/);
  await fails(attack(ply, { kind: 'reorder', seed: -1 }), 'bad_option', /seed/);
  await fails(attack(ply, {}), 'bad_option', /kind/);
  await fails(generate({ name: 'teapot' }), 'bad_option', /teapot/);
});
