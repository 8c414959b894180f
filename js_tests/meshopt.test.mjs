// SPDX-License-Identifier: MIT
// Models that the real encoder of meshoptimizer compressed: read alike natively and in wasm, marked as plain positions.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { MeshoptEncoder } from 'meshoptimizer';
import { createKey, embed, extract, inspect } from 'quadmark';
import { assertTrueBounds, makeGlb, openGltf, padded } from './support/gltf.mjs';
import { readDocument, validatorErrors } from './support/gltf_readers.mjs';
import { logo, sculpture } from './support/marks.mjs';
import { embedNatively, inspectNatively } from './support/native.mjs';

const image = logo(24);
const key = await createKey({ width: 24, height: 24 });
await MeshoptEncoder.ready;

/**
 * Compresses every view of a GLB as its accessors allow.
 *
 * @param version   of the vertex codec, 0 or 1 (the latter under the KHR name)
 * @param indices   mode for triangle lists: TRIANGLES or INDICES
 * @param filter    of positions: NONE or EXPONENTIAL (the caller compares what it rounds to)
 * @param fallback  keep the plain bytes in a second buffer, as a data: URI
 */
function compress(glb, { version = 0, indices = 'TRIANGLES', filter = 'NONE', fallback = false } = {}) {
  const { json, bin } = openGltf(glb);
  const name = version === 0 ? 'EXT_meshopt_compression' : 'KHR_meshopt_compression';
  const parts = [];
  let at = 0;
  json.bufferViews.forEach((view, index) => {
    const accessor = json.accessors.find(({ bufferView }) => bufferView === index);
    const isIndex = accessor.type === 'SCALAR';
    const stride = isIndex ? (accessor.componentType === 5125 ? 4 : 2) : 12;
    const plain = bin.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + accessor.count * stride);
    const mode = isIndex ? indices : 'ATTRIBUTES';
    const isPosition = json.meshes.some(({ primitives }) => primitives.some((p) => json.accessors[p.attributes.POSITION] === accessor));
    const filtered = filter === 'EXPONENTIAL' && isPosition;
    const source = filtered
      ? MeshoptEncoder.encodeFilterExp(new Float32Array(new Uint8Array(plain).buffer), accessor.count, 12, 15, 'Separate')
      : new Uint8Array(plain);
    const stream = MeshoptEncoder.encodeGltfBuffer(source, accessor.count, stride, mode, version);
    view.byteLength = plain.length;
    view.buffer = 1;
    view.extensions = {
      [name]: { buffer: 0, byteOffset: at, byteLength: stream.length, byteStride: stride, count: accessor.count, mode,
        ...(filtered ? { filter } : {}) },
    };
    parts.push(padded(Buffer.from(stream)));
    at += parts.at(-1).length;
  });
  json.buffers = [{ byteLength: at }, fallback
    ? { byteLength: bin.length, uri: `data:application/octet-stream;base64,${bin.toString('base64')}` }
    : { byteLength: bin.length, extensions: { [name]: { fallback: true } } }];
  json.extensionsUsed = [...(json.extensionsUsed ?? []), name];
  if (!fallback) json.extensionsRequired = [...(json.extensionsRequired ?? []), name];
  return makeGlb(json, Buffer.concat(parts));
}

const variants = [
  { version: 0, indices: 'TRIANGLES' }, { version: 0, indices: 'INDICES', fallback: true },
  { version: 1, indices: 'TRIANGLES', fallback: true }, { version: 1, indices: 'INDICES' },
];
const describe = (variant) => Object.entries(variant).map((entry) => entry.join(' ')).join(', ');

for (const vertices of [6000, 70_000]) {  // 16-bit and 32-bit indices, many blocks
  for (const variant of variants) {
    test(`a mark in ${vertices} vertices is read behind meshopt compression (${describe(variant)})`, async (t) => {
      const plain = (await embed(await sculpture('glb', vertices), { key, image })).bytes;
      const compressed = compress(Buffer.from(plain), variant);
      const expected = await extract(plain, { key });
      const found = await extract(compressed, { key });
      assert.equal(found.verdict, 'match');
      assert.deepEqual(found.image, expected.image);
      const described = await inspect(compressed);
      assert.equal(described.vertices, (await inspect(plain)).vertices);
      const natively = await inspectNatively(t, compressed);
      if (natively) assert.deepEqual(described, natively);
    });
  }
}

test('what the exponential filter rounded is read as the decoder of meshoptimizer gives it', async () => {
  const compressed = compress(Buffer.from(await sculpture('glb', 3000)), { filter: 'EXPONENTIAL' });
  const document = await readDocument(compressed);
  const position = document.getRoot().listMeshes()[0].listPrimitives()[0].getAttribute('POSITION');
  const report = await inspect(compressed);
  const min = position.getMinNormalized([]), max = position.getMaxNormalized([]);
  assert.equal(report.diagonal, Math.hypot(...max.map((high, axis) => high - min[axis])));
  assert.equal(report.vertices, position.getCount());
});

for (const variant of variants) {
  test(`marking a meshopt file makes its positions plain and says so (${describe(variant)})`, async (t) => {
    const before = compress(Buffer.from(await sculpture('glb')), variant);
    const marked = await embed(before, { key, image });
    const name = variant.version === 0 ? 'EXT_meshopt_compression' : 'KHR_meshopt_compression';
    const said = marked.report.warnings.filter((warning) => warning.includes(`no longer compressed by ${name}`));
    assert.equal(said.length, 1);
    assert.ok(marked.report.bytesChanged > 0);

    const { json, bin } = openGltf(marked.bytes);
    const original = openGltf(before);
    const position = json.meshes[0].primitives[0].attributes.POSITION;
    const view = json.accessors[position].bufferView;
    assert.equal(json.bufferViews[view].extensions, undefined);
    json.bufferViews.forEach((other, index) => {
      if (index !== view) assert.deepEqual(other, original.json.bufferViews[index]);
    });
    assert.deepEqual(bin.subarray(0, original.bin.length), original.bin);
    assertTrueBounds(json, [bin]);
    assert.ok(await validatorErrors(marked.bytes) <= await validatorErrors(before));
    if (variant.version === 0) await readDocument(marked.bytes);  // glTF-Transform does not know the other name yet
    const found = await extract(marked.bytes, { key });
    assert.equal(found.verdict, 'match');
    assert.equal(found.report.image.erased, 0);

    const natively = await embedNatively(t, before, key, image);
    if (natively) assert.equal(Buffer.compare(natively, Buffer.from(marked.bytes)), 0, 'native and wasm differ');
  });
}
