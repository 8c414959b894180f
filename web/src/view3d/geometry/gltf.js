// SPDX-License-Identifier: MIT
// glTF and GLB as triangles. The core has read the file before and refused what is broken; what slips through throws.
import { decodedUri } from '../../files/paths.js';
import { readAccessor } from './accessors.js';
import { decodePrimitives } from './draco.js';
import { documentOf, IDENTITY, instancesOf } from './gltf_scene.js';
import { numberVertices } from './numbering.js';

async function openBuffers({ json, bin }, open) {
  return Promise.all((json.buffers ?? []).map(async ({ uri }, i) => {
    if (uri === undefined) return i === 0 ? bin : null;
    if (!uri.startsWith('data:')) return open(uri);
    const [head, body] = uri.split(/,(.*)/s);
    const text = head.endsWith(';base64') ? atob(body) : decodedUri(body);
    return Uint8Array.from(text, (character) => character.charCodeAt(0));
  }));
}

/** Bytes of all buffer views, those of meshopt decoded; null where there are none. */
async function openViews({ json }, buffers) {
  return Promise.all((json.bufferViews ?? []).map(async (view) => {
    const packed = view.extensions?.EXT_meshopt_compression ?? view.extensions?.KHR_meshopt_compression;
    if (!packed) return buffers[view.buffer]?.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength) ?? null;
    const { MeshoptDecoder } = await import('meshoptimizer/decoder');
    await MeshoptDecoder.ready;
    const out = new Uint8Array(packed.count * packed.byteStride);
    const start = packed.byteOffset ?? 0;
    MeshoptDecoder.decodeGltfBuffer(out, packed.count, packed.byteStride, buffers[packed.buffer].subarray(start, start + packed.byteLength), packed.mode, packed.filter);
    return out;
  }));
}

/** Triangles of a primitive: strips and fans opened. */
function trianglesOf(file, { indices, mode = 4 }, vertexCount) {
  const corners = indices === undefined ? Uint32Array.from({ length: vertexCount }, (_, i) => i) : readAccessor(file, indices, Uint32Array);
  if (mode === 4) return corners.subarray(0, corners.length - corners.length % 3);
  const out = new Uint32Array(3 * Math.max(0, corners.length - 2));
  for (let i = 0; i + 2 < corners.length; ++i) {
    const [a, b] = mode === 6 ? [0, i + 1] : i % 2 === 0 ? [i, i + 1] : [i + 1, i];
    out.set([corners[a], corners[b], corners[i + 2]], 3 * i);
  }
  return out;
}

/** Reads a .gltf or .glb; see readGeometry(). */
export async function readGltf(bytes, open, openDraco) {
  const file = documentOf(bytes);
  const { json } = file;
  const isDrawn = ({ mode = 4, attributes }) => [4, 5, 6].includes(mode) && attributes?.POSITION !== undefined;
  const primitives = (json.meshes ?? []).flatMap(({ primitives: all }) => all.filter(isDrawn));
  file.views = await openViews(file, await openBuffers(file, open));
  if (primitives.some(({ extensions }) => extensions?.KHR_draco_mesh_compression)) decodePrimitives(await openDraco(), file, primitives);
  const { numbersOf, vertexCount } = numberVertices(file, primitives);
  const shapes = new Map(primitives.map((primitive) => {
    const { POSITION, NORMAL } = primitive.attributes;
    const positions = readAccessor(file, POSITION, Float32Array);
    return [primitive, {
      positions, triangles: trianglesOf(file, primitive, positions.length / 3), numbers: numbersOf.get(POSITION),
      normals: NORMAL === undefined ? null : readAccessor(file, NORMAL, Float32Array),
    }];
  }));
  const instances = instancesOf(json);
  const drawn = instances.length > 0 ? instances : (json.meshes ?? []).map((_, mesh) => ({ mesh, matrix: IDENTITY }));
  const pieces = drawn.flatMap(({ mesh, matrix }) => json.meshes[mesh].primitives.filter(isDrawn).map((primitive) => ({ ...shapes.get(primitive), matrix })));
  return { pieces, vertexCount };
}
