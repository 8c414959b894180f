// SPDX-License-Identifier: MIT
// glTF taken apart with nothing of ours: containers, and what a mark may change in them.
import assert from 'node:assert/strict';

const asBuffer = (bytes) => Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength);

export const isGlb = (bytes) => asBuffer(bytes).toString('latin1', 0, 4) === 'glTF';

/** { text, json, bin } of a GLB or .gltf file. */
export function openGltf(bytes) {
  const file = asBuffer(bytes);
  if (!isGlb(file)) return { text: file.toString(), json: JSON.parse(file.toString()), bin: null };
  assert.equal(file.readUInt32LE(8), file.length, 'GLB length field');
  const jsonLength = file.readUInt32LE(12);
  assert.equal(jsonLength % 4, 0, 'JSON chunk is padded');
  const text = file.toString('utf8', 20, 20 + jsonLength);
  const at = 20 + jsonLength;
  const bin = at < file.length ? file.subarray(at + 8, at + 8 + file.readUInt32LE(at)) : null;
  return { text, json: JSON.parse(text), bin };
}

/** Bytes up to the next multiple of 4. */
export const padded = (bytes, by = 0) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, by)]);

/** A GLB of a JSON object and a BIN chunk. */
export function makeGlb(json, bin) {
  const header = Buffer.alloc(12);
  header.write('glTF', 'latin1');
  header.writeUInt32LE(2, 4);
  const chunks = [[0x4e4f534a, padded(Buffer.from(JSON.stringify(json)), ' ')], [0x004e4942, padded(bin)]];
  const file = Buffer.concat([header, ...chunks.flatMap(([type, data]) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(data.length, 0);
    head.writeUInt32LE(type, 4);
    return [head, data];
  })]);
  file.writeUInt32LE(file.length, 8);
  return file;
}

/** Makes a .gltf with the external buffer `uri` from a GLB. */
export function splitGlb(glb, uri) {
  const { json, bin } = openGltf(glb);
  json.buffers[0].uri = uri;
  json.buffers[0].byteLength = bin.length;
  return { gltf: Buffer.from(JSON.stringify(json, null, 1)), bin: Buffer.from(bin) };
}

/** Indices of the accessors that hold positions of triangles. */
export const positionAccessors = (json) => new Set(json.meshes.flatMap((mesh) => mesh.primitives)
  .filter((primitive) => (primitive.mode ?? 4) >= 4).map((primitive) => primitive.attributes.POSITION));

/** Fails unless the two JSON texts are one but for min and max of POSITION accessors. */
export function assertSameJson(before, after) {
  const mask = (text) => text.replace(/"(min|max)"\s*:\s*\[[^\]]*\]/g, '"$1":[]').trimEnd();
  assert.equal(mask(after.text), mask(before.text), 'JSON text outside min and max');
  const strip = ({ json }) => {
    const copy = structuredClone(json);
    for (const index of positionAccessors(json)) {
      delete copy.accessors[index].min;
      delete copy.accessors[index].max;
    }
    return copy;
  };
  assert.deepEqual(strip(after), strip(before), 'JSON outside min and max of POSITION');
}

/** Fails unless buffer `index` differs only inside POSITION components. Returns how many bytes differ. */
export function assertOnlyPositionsDiffer(json, index, before, after) {
  assert.equal(after.length, before.length, 'buffer length');
  const allowed = new Uint8Array(before.length);
  for (const number of positionAccessors(json)) {
    const accessor = json.accessors[number];
    const view = json.bufferViews[accessor.bufferView];
    if (view.buffer !== index) continue;
    const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    for (let i = 0; i < accessor.count; ++i) {
      const at = start + i * (view.byteStride ?? 12);
      allowed.fill(1, at, at + 12);
    }
  }
  let changed = 0;
  for (let i = 0; i < before.length; ++i) {
    if (before[i] === after[i]) continue;
    assert.ok(allowed[i], `byte ${i} of buffer ${index} differs outside POSITION`);
    ++changed;
  }
  return changed;
}

/** Fails unless min and max of every POSITION accessor are those of its stored values. */
export function assertTrueBounds(json, buffers) {
  for (const number of positionAccessors(json)) {
    const accessor = json.accessors[number];
    const view = json.bufferViews[accessor.bufferView];
    const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < accessor.count; ++i) {
      for (let axis = 0; axis < 3; ++axis) {
        const value = buffers[view.buffer].readFloatLE(start + i * (view.byteStride ?? 12) + 4 * axis);
        min[axis] = Math.min(min[axis], value);
        max[axis] = Math.max(max[axis], value);
      }
    }
    assert.deepEqual(accessor.min.map(Math.fround), min, `accessor ${number}: min`);
    assert.deepEqual(accessor.max.map(Math.fround), max, `accessor ${number}: max`);
  }
}
