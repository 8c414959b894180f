// SPDX-License-Identifier: MIT
// Draco data made by the real encoder, and read by the real decoder.
import draco3d from 'draco3dgltf';
import { makeGlb, openGltf } from './gltf.mjs';

const encoder = await draco3d.createEncoderModule();
const decoder = await draco3d.createDecoderModule();

/**
 * Compresses a triangle mesh.
 *
 * @param attributes  { POSITION: [Float32Array, 3], NORMAL: ..., TEXCOORD_0: [Float32Array, 2] }
 * @param indices     corners, three per triangle
 * @param method      'edgebreaker' or 'sequential'
 * @param bits        quantization of positions; 0 keeps floats
 * @param speed       0 (smallest, by valences) to 10
 * @return { bytes, ids: { POSITION: id, ... } }
 */
export function encodeDraco(attributes, indices, { method = 'edgebreaker', bits = 0, speed = 5 } = {}) {
  const builder = new encoder.MeshBuilder();
  const mesh = new encoder.Mesh();
  const types = { POSITION: encoder.POSITION, NORMAL: encoder.NORMAL, TEXCOORD_0: encoder.TEX_COORD };
  builder.AddFacesToMesh(mesh, indices.length / 3, Uint32Array.from(indices));
  const ids = {};
  for (const [name, [values, components]] of Object.entries(attributes)) {
    ids[name] = builder.AddFloatAttributeToMesh(mesh, types[name], values.length / components, components, values);
  }
  const coder = new encoder.Encoder();
  coder.SetEncodingMethod(method === 'sequential' ? encoder.MESH_SEQUENTIAL_ENCODING : encoder.MESH_EDGEBREAKER_ENCODING);
  coder.SetSpeedOptions(speed, speed);
  if (bits > 0) coder.SetAttributeQuantization(encoder.POSITION, bits);
  const out = new encoder.DracoInt8Array();
  const length = coder.EncodeMeshToDracoBuffer(mesh, out);
  const bytes = Buffer.from(Array.from({ length }, (_, i) => out.GetValue(i) & 255));
  for (const object of [out, coder, mesh, builder]) encoder.destroy(object);
  return { bytes, ids };
}

/** The positions of a bare .drc, x y z x y z ... */
export function decodeDraco(bytes) {
  const coder = new decoder.Decoder(), mesh = new decoder.Mesh(), values = new decoder.DracoFloat32Array();
  try {
    if (!coder.DecodeArrayToMesh(new Int8Array(bytes), bytes.length, mesh).ok()) throw new Error('not a Draco mesh');
    coder.GetAttributeFloatForAllPoints(mesh, coder.GetAttribute(mesh, coder.GetAttributeId(mesh, decoder.POSITION)), values);
    return Float64Array.from({ length: values.size() }, (_, i) => values.GetValue(i));
  } finally {
    for (const object of [values, mesh, coder]) decoder.destroy(object);
  }
}

/** { positions, normals, uvs, indices } of a GLB with one primitive; made-up normals and texture coordinates. */
export function meshOf(glb) {
  const { json, bin } = openGltf(glb);
  const { attributes, indices } = json.meshes[0].primitives[0];
  const read = (number) => {
    const accessor = json.accessors[number];
    const view = json.bufferViews[accessor.bufferView];
    const Type = { 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array }[accessor.componentType];
    const length = accessor.count * (accessor.type === 'VEC3' ? 3 : 1);
    const begin = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    return new Type(Uint8Array.from(bin.subarray(begin, begin + length * Type.BYTES_PER_ELEMENT)).buffer);
  };
  const positions = read(attributes.POSITION);
  const count = positions.length / 3;
  return {
    positions, count, indices: read(indices),
    normals: Float32Array.from({ length: 3 * count }, (_, i) => (i % 3 === 2 ? 1 : 0)),
    uvs: Float32Array.from({ length: 2 * count }, (_, i) => (i % 64) / 64),
  };
}

/** The same model with Draco compression; with a fallback, the plain data is still in the file. */
export function compressGlb(glb, { fallback = false, ...options } = {}) {
  const { positions, normals, uvs, indices, count } = meshOf(glb);
  const { bytes, ids } = encodeDraco({ POSITION: [positions, 3], NORMAL: [normals, 3], TEXCOORD_0: [uvs, 2] }, indices, options);
  const min = [0, 1, 2].map((axis) => positions.reduce((low, value, i) => (i % 3 === axis ? Math.min(low, value) : low), Infinity));
  const max = [0, 1, 2].map((axis) => positions.reduce((high, value, i) => (i % 3 === axis ? Math.max(high, value) : high), -Infinity));
  const json = {
    asset: { version: '2.0' }, extensionsUsed: ['KHR_draco_mesh_compression'], scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    ...(fallback ? {} : { extensionsRequired: ['KHR_draco_mesh_compression'] }),
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1, TEXCOORD_0: 2 }, indices: 3,
      extensions: { KHR_draco_mesh_compression: { bufferView: 0, attributes: ids } } }] }],
    accessors: [{ componentType: 5126, count, type: 'VEC3', min, max }, { componentType: 5126, count, type: 'VEC3' },
      { componentType: 5126, count, type: 'VEC2' }, { componentType: 5125, count: indices.length, type: 'SCALAR' }],
    bufferViews: [{ buffer: 0, byteLength: bytes.length }],
  };
  const parts = [bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4)];
  if (fallback) {
    [positions, normals, uvs, Uint32Array.from(indices)].forEach((values, accessor) => {
      const byteOffset = parts.reduce((sum, part) => sum + part.length, 0);
      json.accessors[accessor].bufferView = json.bufferViews.push({ buffer: 0, byteOffset, byteLength: values.byteLength }) - 1;
      parts.push(Buffer.from(values.buffer));
    });
  }
  const bin = Buffer.concat(parts);
  json.buffers = [{ byteLength: bin.length }];
  return makeGlb(json, bin);
}

/** A small .drc: a bumpy square of 3 x 3 points. */
export const drc = encodeDraco(
  { POSITION: [Float32Array.of(0, 0, 0.125, 1, 0, -0.5, 2, 0, 0.25, 0, 1, 0.75, 1.0625, 1, 0, 2, 1, -0.25, 0, 2, 0, 1, 2, 0.5, 2, 2, -1), 3] },
  [0, 1, 4, 0, 4, 3, 1, 2, 4, 2, 5, 4, 3, 4, 6, 4, 7, 6, 4, 5, 8, 4, 8, 7]).bytes;
