// SPDX-License-Identifier: MIT
// Draco's data as plain arrays. Points keep the order the decoder gives them, which is the core's.
import { componentBytes } from './accessors.js';
import { IDENTITY } from './gltf_scene.js';

const FLOAT = 5126, UINT32 = 5125;
const TYPES = { 5120: 'DT_INT8', 5121: 'DT_UINT8', 5122: 'DT_INT16', 5123: 'DT_UINT16', 5125: 'DT_UINT32', 5126: 'DT_FLOAT32' };

/** Runs `read` on bytes of the decoder's own memory and returns a copy of what it wrote there. */
function written(draco, length, read) {
  const pointer = draco._malloc(length);
  const isRead = read(pointer);
  const bytes = draco.HEAPU8.slice(pointer, pointer + length);
  draco._free(pointer);
  if (!isRead) throw new Error('Draco: the stream does not hold what it should');
  return bytes;
}

/**
 * @param draco       Draco's decoder module
 * @param bytes       a stream of a mesh
 * @param attributes  [{ find: (decoder, mesh) => attribute, componentType }], of three components each
 * @return {{ points: number, corners: Uint8Array, values: Uint8Array[] }}  corners: three uint32 per triangle
 */
function decodeMesh(draco, bytes, attributes) {
  const decoder = new draco.Decoder(), mesh = new draco.Mesh();
  try {
    const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
    if (!status.ok()) throw new Error(`Draco: ${status.error_msg()}`);
    const points = mesh.num_points(), cornerBytes = 12 * mesh.num_faces();
    return {
      points,
      corners: written(draco, cornerBytes, (pointer) => decoder.GetTrianglesUInt32Array(mesh, cornerBytes, pointer)),
      values: attributes.map(({ find, componentType }) => {
        const attribute = find(decoder, mesh), length = points * 3 * componentBytes(componentType);
        return written(draco, length, (pointer) => attribute.ptr !== 0
          && decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, draco[TYPES[componentType]], length, pointer));
      }),
    };
  } finally {
    draco.destroy(mesh);
    draco.destroy(decoder);
  }
}

/**
 * Puts the decoded data of primitives with KHR_draco_mesh_compression into `file` as further views, with accessors of
 * their own, and lets the primitives use those. One stream and attribute is decoded once, however many primitives use it.
 * @param file  { json, views }, changed
 */
export function decodePrimitives(draco, { json, views }, primitives) {
  const add = (bytes, accessor) => {
    views.push(bytes);
    json.bufferViews.push({ buffer: json.buffers.push({}) - 1, byteLength: bytes.length });
    return json.accessors.push({ ...accessor, bufferView: json.bufferViews.length - 1 }) - 1;
  };
  const known = new Map();
  for (const primitive of primitives) {
    const packed = primitive.extensions?.KHR_draco_mesh_compression;
    if (!packed) continue;
    const stream = `${packed.bufferView} ${packed.attributes.POSITION}`;
    if (!known.has(stream)) {
      const names = ['POSITION', 'NORMAL'].filter((name) => packed.attributes[name] !== undefined && primitive.attributes[name] !== undefined);
      const wanted = names.map((name) => ({ name, ...json.accessors[primitive.attributes[name]] }));
      const { points, corners, values } = decodeMesh(draco, views[packed.bufferView], wanted.map(({ name, componentType }) => (
        { componentType, find: (decoder, mesh) => decoder.GetAttributeByUniqueId(mesh, packed.attributes[name]) })));
      const attributes = Object.fromEntries(wanted.map(({ name, componentType, normalized }, i) =>
        [name, add(values[i], { componentType, normalized, type: 'VEC3', count: points })]));
      known.set(stream, { attributes, indices: add(corners, { componentType: UINT32, type: 'SCALAR', count: corners.length / 4 }), mode: 4 });
    }
    Object.assign(primitive, known.get(stream));
  }
}

/** Reads a .drc; see readGeometry(). */
export function readDrc(draco, bytes) {
  const find = (decoder, mesh) => decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, draco.POSITION));
  const { points, corners, values: [positions] } = decodeMesh(draco, bytes, [{ find, componentType: FLOAT }]);
  const piece = {
    positions: new Float32Array(positions.buffer), triangles: new Uint32Array(corners.buffer), normals: null,
    numbers: Uint32Array.from({ length: points }, (_, i) => i), matrix: IDENTITY,
  };
  return { pieces: [piece], vertexCount: points };
}
