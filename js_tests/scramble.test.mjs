// SPDX-License-Identifier: MIT
// A key with scrambleOrder: the same surface with the same attributes in another order, checked with nothing of ours.
import assert from 'node:assert/strict';
import { basename } from 'node:path';
import { test } from 'node:test';
import { createKey, embed, extract } from 'quadmark';
import { readModelFiles, realModels } from './support/files.mjs';
import { splitGlb } from './support/gltf.mjs';
import { readDocument, validatorErrors } from './support/gltf_readers.mjs';
import { logo, sculpture } from './support/marks.mjs';

const scrambled = (report) => report.warnings.find((text) => /the order of the vertices was scrambled/.test(text));

/** Per primitive, the attributes and morph targets that each corner of its triangles reads, as text. */
async function corners(bytes, resources) {
  const document = await readDocument(bytes, resources);
  return document.getRoot().listMeshes().map((mesh) => mesh.listPrimitives().map((primitive) => {
    const sets = [primitive, ...primitive.listTargets()];
    const streams = sets.flatMap((set) => set.listSemantics().map((name) => [name, set.getAttribute(name)]));
    return Array.from(primitive.getIndices().getArray(), (vertex) =>
      streams.map(([name, accessor]) => `${name} ${accessor.getElement(vertex, [])}`).join('; '));
  }));
}

async function check(name, model, resources, size) {
  const image = logo(size);
  const scrambling = await createKey({ width: size, height: size, scrambleOrder: true });
  const plainKey = structuredClone(scrambling);
  delete plainKey.params.scrambleOrder;
  const plain = await embed(model, { key: plainKey, image, resources });
  const marked = await embed(model, { key: scrambling, image, resources });
  assert.equal(scrambled(plain.report), undefined, name);
  assert.ok(scrambled(marked.report), `${name}: ${marked.report.warnings}`);
  const plainFiles = { ...resources, ...plain.resources }, files = { ...resources, ...marked.resources };
  assert.notDeepEqual([marked.bytes, marked.resources], [plain.bytes, plain.resources], name);
  assert.ok(marked.report.bytesChanged > plain.report.bytesChanged, name);
  assert.deepEqual(await corners(marked.bytes, files), await corners(plain.bytes, plainFiles), name);
  assert.equal(await validatorErrors(marked.bytes, files), await validatorErrors(model, resources), `${name}: validator errors`);
  const read = await extract(marked.bytes, { key: scrambling, resources: files });
  assert.equal(read.verdict, 'match', name);
  assert.deepEqual(read.image.bits, image.bits, name);
}

test('a GLB', async () => check('sculpture.glb', await sculpture('glb'), {}, 24));

test('a .gltf with an external buffer', async () => {
  const { gltf, bin } = splitGlb(await sculpture('glb'), 'mesh.bin');
  await check('sculpture.gltf', gltf, { 'mesh.bin': bin }, 24);
});

test('a PLY: another order for every key, read by both', async () => {
  const model = await sculpture('ply');
  const image = logo();
  const files = [];
  for (let i = 0; i < 2; ++i) {
    const key = await createKey({ width: 24, height: 24, scrambleOrder: true });
    const { bytes, report } = await embed(model, { key, image });
    assert.ok(scrambled(report));
    assert.equal(bytes.length, model.length);
    assert.deepEqual((await extract(bytes, { key })).image.bits, image.bits);
    files.push(bytes);
  }
  assert.notDeepEqual(files[0], files[1]);
});

test('real models, skinned ones too, keep every attribute at its corner', async (t) => {
  for (const { name, path } of realModels(t, ['CesiumMan.glb', 'riggedMesh.glb', 'moltenDagger.glb'])) {
    const { model, resources } = await readModelFiles(path);
    await check(basename(name), model, resources, 8);
  }
});
