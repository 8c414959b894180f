// SPDX-License-Identifier: MIT
// A marked glTF is the user's own file but for position components and their min / max, checked with nothing of ours:
// by bytes, by the Khronos validator and by loading it with another library.
import assert from 'node:assert/strict';
import { basename } from 'node:path';
import { test } from 'node:test';
import { createKey, embed, extract } from 'quadmark';
import { readModelFiles, realModels } from './support/files.mjs';
import { assertOnlyPositionsDiffer, assertSameJson, assertTrueBounds, openGltf, splitGlb } from './support/gltf.mjs';
import { readDocument, validatorErrors } from './support/gltf_readers.mjs';
import { logo, sculpture } from './support/marks.mjs';

/** Buffers of a glTF by index, from the BIN chunk, data URIs or resources. */
function buffersOf({ json, bin }, resources) {
  return json.buffers.map(({ uri }) => {
    if (uri === undefined) return bin;
    if (uri.startsWith('data:')) return Buffer.from(uri.slice(uri.indexOf(',') + 1), 'base64');
    return Buffer.from(resources[uri]);
  });
}

async function check(name, model, resources, size, { dataUris = false } = {}) {
  const image = logo(size);
  const key = await createKey({ width: size, height: size });
  const marked = await embed(model, { key, image, resources });
  const all = { ...resources, ...marked.resources };
  const before = openGltf(model), after = openGltf(marked.bytes);
  if (!dataUris) assertSameJson(before, after);
  const old = buffersOf(before, resources), now = buffersOf(after, all);
  const changed = old.reduce((sum, bytes, i) => sum + assertOnlyPositionsDiffer(before.json, i, bytes, now[i]), 0);
  assert.ok(changed > 0, name);
  assertTrueBounds(after.json, now);
  assert.equal(await validatorErrors(marked.bytes, all), await validatorErrors(model, resources), `${name}: validator errors`);
  const read = await extract(marked.bytes, { key, resources: all });
  assert.equal(read.verdict, 'match', name);
  assert.deepEqual(read.image.bits, image.bits, name);
  return marked;
}

test('a GLB', async () => {
  const model = await sculpture('glb');
  const { bytes } = await check('sculpture.glb', model, {}, 24);
  const document = await readDocument(bytes);
  assert.equal(document.getRoot().listMeshes().length, openGltf(model).json.meshes.length);
});

test('a .gltf with an external buffer', async () => {
  const { gltf, bin } = splitGlb(await sculpture('glb'), 'mesh.bin');
  await check('sculpture.gltf', gltf, { 'mesh.bin': bin }, 24);
});

test('a .gltf with its buffer in a data URI', async () => {
  const { json, bin } = openGltf(await sculpture('glb'));
  json.buffers[0].uri = `data:application/octet-stream;base64,${bin.toString('base64')}`;
  await check('data.gltf', Buffer.from(JSON.stringify(json)), {}, 24, { dataUris: true });
});

test('what glTF tools tend to lose stays: odd numbers, unknown members, duplicate extras, an unknown chunk', async () => {
  const { json, bin } = openGltf(await sculpture('glb'));
  delete json.buffers[0].uri;
  let text = JSON.stringify({ ...json, extras: { big: 0, tiny: 0, empty: {}, nothing: null }, 'x-studio': [1] }, null, '\t');
  text = text.replace('"big": 0', '"big": 12345678901234567890').replace('"tiny": 0', '"tiny": 1.500E-7, "é\\u0041": "\\/"');
  while (Buffer.byteLength(text) % 4 !== 0) text += ' ';
  const chunk = (type, data) => {
    const header = Buffer.alloc(8);
    header.writeUInt32LE(data.length, 0);
    header.write(type, 4, 'latin1');
    return Buffer.concat([header, data]);
  };
  const body = Buffer.concat([chunk('JSON', Buffer.from(text)), chunk('BIN\0', bin), chunk('XTRA', Buffer.from('12345678'))]);
  const header = Buffer.from('glTF\x02\0\0\0\0\0\0\0', 'latin1');
  header.writeUInt32LE(12 + body.length, 8);
  const { bytes } = await check('torture.glb', Buffer.concat([header, body]), {}, 24);
  assert.equal(Buffer.from(bytes).subarray(-16).toString('latin1'), chunk('XTRA', Buffer.from('12345678')).toString('latin1'));
});

test('real glTF files', async (t) => {
  const names = ['bunny.glb', 'CesiumMan.glb', 'Duck.glb', 'SheenCloth.glb', 'clothFolds.glb', 'riggedMesh.glb',
    'shaderBall.glb', 'moltenDagger.glb', 'ogre.glb', 'nefertiti.glb', 'Fox/Fox.gltf'];
  for (const { name, path } of realModels(t, names)) {
    const { model, resources } = await readModelFiles(path);
    try {
      await check(basename(name), model, resources, /bunny|ogre|nefertiti|Sheen|cloth/.test(name) ? 24 : 8);
    } catch (error) {
      // A small model may be too small, but must say so.
      if (error.code !== 'capacity') throw error;
      t.diagnostic(`${name}: ${error.message}`);
    }
  }
});
