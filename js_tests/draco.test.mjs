// SPDX-License-Identifier: MIT
// Models that the real encoder of Draco compressed: read alike natively and in wasm, marked as plain accessors.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey, embed, extract, inspect } from 'quadmark';
import { compressGlb, encodeDraco, meshOf } from './support/draco.mjs';
import { quadmark, realModel, temporaryFolder } from './support/files.mjs';
import { assertTrueBounds, openGltf } from './support/gltf.mjs';
import { readDocument, validatorErrors } from './support/gltf_readers.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';
import { embedNatively, inspectNatively } from './support/native.mjs';

const image = logo(24);
const key = await createKey({ width: 24, height: 24 });

const variants = [
  { method: 'edgebreaker' }, { method: 'edgebreaker', speed: 0, fallback: true }, { method: 'sequential' },
  { method: 'edgebreaker', bits: 14 }, { method: 'sequential', bits: 16 },
];
const describe = (variant) => Object.entries(variant).map((entry) => entry.join(' ')).join(', ');

for (const variant of variants) {
  test(`a mark is read behind Draco compression (${describe(variant)})`, async (t) => {
    const plain = Buffer.from((await embed(await sculpture('glb', 6000), { key, image })).bytes);
    const compressed = compressGlb(plain, variant);
    const described = await inspect(compressed);
    const expected = await inspect(plain);
    assert.equal(described.faces, expected.faces);
    const natively = await inspectNatively(t, compressed);
    if (natively) assert.deepEqual(described, natively);
    const found = await extract(compressed, { key });
    if (!variant.bits) {  // what quantization leaves of the mark is another question
      assert.equal(described.weldedVertices, expected.weldedVertices);
      assert.equal(found.verdict, 'match');
      assert.deepEqual(found.image.bits, (await extract(plain, { key })).image.bits);
    }

    const { positions, indices } = meshOf(plain);
    const { bytes } = encodeDraco({ POSITION: [positions, 3] }, indices, variant);
    const bare = await inspect(bytes);
    assert.equal(bare.format, 'drc');
    assert.equal(bare.faces, expected.faces);
    const bareNatively = await inspectNatively(t, bytes);
    if (bareNatively) assert.deepEqual(bare, bareNatively);
    if (!variant.bits) assert.equal((await extract(bytes, { key })).verdict, 'match');
  });

  test(`marking a Draco file makes its accessors plain and says so (${describe(variant)})`, async (t) => {
    const before = compressGlb(await sculpture('glb'), variant);
    const marked = await embed(before, { key, image });
    const said = marked.report.warnings.filter((warning) => warning.includes('no longer compressed by KHR_draco_mesh_compression'));
    assert.equal(said.length, 1);
    const { json, bin } = openGltf(marked.bytes);
    assert.equal(json.extensionsUsed, undefined);
    assert.equal(json.extensionsRequired, undefined);
    assert.deepEqual(bin.subarray(0, openGltf(before).bin.length), openGltf(before).bin);
    assertTrueBounds(json, [bin]);
    assert.ok(await validatorErrors(marked.bytes) <= await validatorErrors(before));

    // The other attributes are what Draco's own decoder gives, point by point.
    const [was, is] = (await Promise.all([readDocument(before), readDocument(marked.bytes)]))
      .map((document) => document.getRoot().listMeshes()[0].listPrimitives()[0]);
    for (const semantic of ['NORMAL', 'TEXCOORD_0']) {
      assert.deepEqual(is.getAttribute(semantic).getArray(), was.getAttribute(semantic).getArray(), semantic);
    }
    assert.deepEqual([...is.getIndices().getArray()], [...was.getIndices().getArray()]);
    assert.equal((await extract(marked.bytes, { key })).verdict, 'match');
    const natively = await embedNatively(t, before, key, image);
    if (natively) assert.equal(Buffer.compare(natively, Buffer.from(marked.bytes)), 0, 'native and wasm differ');
  });
}

test('a .drc is read but not marked', async (t) => {
  const path = realModel(t, 'bunny_gltf.drc');
  if (path) {
    const report = await inspect(readFileSync(path));
    assert.equal(report.vertices, 34_834);
    assert.equal(report.faces, 69_451);
    const natively = await inspectNatively(t, readFileSync(path));
    if (natively) assert.deepEqual(report, natively);
  }
  const { positions, indices } = meshOf(await sculpture('glb', 3000));
  const { bytes } = encodeDraco({ POSITION: [positions, 3] }, indices);
  await assert.rejects(embed(bytes, { key, image }), { code: 'unsupported_file', message: /mark the PLY, glTF or GLB/ });
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, 'model.drc'), bytes);
  writeFileSync(join(folder, 'key.json'), JSON.stringify(key));
  writeFileSync(join(folder, 'logo.png'), logoPng(image));
  const refused = await quadmark(['embed', 'model.drc', 'marked.drc', '--key', 'key.json', '--image', 'logo.png'], { cwd: folder });
  assert.equal(refused.status, 1);
  assert.match(refused.stderr, /a \.drc cannot be marked/);
  assert.equal((await quadmark(['extract', 'model.drc', '--key', 'key.json'], { cwd: folder })).status, 3);
  assert.equal((await quadmark(['inspect', 'model.drc'], { cwd: folder })).status, 0);
});

test('the sample of Khronos is read as the box it is', async (t) => {
  const path = realModel(t, 'Box_Draco.glb');
  if (!path) return;
  const report = await inspect(readFileSync(path));
  assert.equal(report.weldedVertices, 8);
  assert.equal(report.faces, 12);
});
