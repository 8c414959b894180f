// SPDX-License-Identifier: MIT
// glTF and GLB as triangles. The core has read the file before and refused what is broken; what slips through throws.
import { decodedUri } from '../../files/paths.js';
import { documentOf, IDENTITY, instancesOf } from './gltf_scene.js';
import { NotDrawable } from './not_drawable.js';

const COMPONENTS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
const DIVISORS = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };

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

/** Elements of an accessor as `Target`, sparse values in their places, normalized integers divided. */
function readAccessor({ json, views }, index, Target) {
  const accessor = json.accessors[index];
  const width = WIDTHS[accessor.type];
  const divisor = accessor.normalized ? DIVISORS[accessor.componentType] : 1;
  const out = new Target(accessor.count * width);
  const copy = (view, offset, stride, count, place) => {
    const Type = COMPONENTS[accessor.componentType];
    const step = (stride ?? width * Type.BYTES_PER_ELEMENT) / Type.BYTES_PER_ELEMENT;
    // An aligned copy: views may begin anywhere in a GLB.
    const values = new Type(view.slice(offset, offset + ((count - 1) * step + width) * Type.BYTES_PER_ELEMENT).buffer);
    for (let i = 0; i < count; ++i) {
      for (let axis = 0; axis < width; ++axis) out[place(i) * width + axis] = values[i * step + axis] / divisor;
    }
  };
  if (accessor.bufferView !== undefined) {
    copy(views[accessor.bufferView], accessor.byteOffset ?? 0, json.bufferViews[accessor.bufferView].byteStride, accessor.count, (i) => i);
  }
  if (accessor.sparse) {
    const { count, indices, values } = accessor.sparse;
    const Type = COMPONENTS[indices.componentType];
    const at = indices.byteOffset ?? 0;
    const places = new Type(views[indices.bufferView].slice(at, at + count * Type.BYTES_PER_ELEMENT).buffer);
    copy(views[values.bufferView], values.byteOffset ?? 0, undefined, count, (i) => places[i]);
  }
  return out;
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

/**
 * The first vertex of each POSITION accessor in the core's mesh: accessors follow one another in the order of their
 * first use, and those that are windows onto the same bytes share vertices (core/src/io/gltf_arrays.cpp).
 * @return {{ firstOf: Map<number, number>, vertexCount: number }}
 */
function numberVertices({ json }, primitives) {
  const layouts = [...new Set(primitives.map(({ attributes }) => attributes.POSITION))].map((index) => {
    const { bufferView, byteOffset = 0, componentType, normalized = false, count, sparse } = json.accessors[index];
    if (bufferView === undefined || sparse) return null;
    const view = json.bufferViews[bufferView];
    const width = 3 * COMPONENTS[componentType].BYTES_PER_ELEMENT;
    const stride = view.byteStride ?? width;
    const packed = view.extensions?.EXT_meshopt_compression || view.extensions?.KHR_meshopt_compression;
    const start = packed ? byteOffset : (view.byteOffset ?? 0) + byteOffset;
    return { index, place: packed ? `view ${bufferView}` : `buffer ${view.buffer}`, kind: [stride, start % stride, componentType, normalized].join(), start, stride, width, count };
  });
  if (layouts.includes(null)) return { firstOf: new Map(), vertexCount: 0 };
  const arrays = [];
  for (const layout of layouts.toSorted((a, b) => a.start - b.start)) {
    const array = arrays.findLast(({ place, kind }) => place === layout.place && kind === layout.kind);
    if (array && layout.start < array.start + array.stride * (array.count - 1) + array.width) {
      array.count = Math.max(array.count, (layout.start - array.start) / array.stride + layout.count);
      layout.array = array;
    } else {
      arrays.push(layout.array = { ...layout, first: null });
    }
  }
  let vertexCount = 0;
  for (const { array } of layouts) {
    if (array.first !== null) continue;
    array.first = vertexCount;
    vertexCount += array.count;
  }
  return { firstOf: new Map(layouts.map(({ index, array, start, stride }) => [index, array.first + (start - array.start) / stride])), vertexCount };
}

/** Reads a .gltf or .glb; see readGeometry(). */
export async function readGltf(bytes, open) {
  const file = documentOf(bytes);
  const { json } = file;
  const isDrawn = ({ mode = 4, attributes }) => [4, 5, 6].includes(mode) && attributes?.POSITION !== undefined;
  const primitives = (json.meshes ?? []).flatMap(({ primitives: all }) => all.filter(isDrawn));
  if (primitives.some(({ extensions }) => extensions?.KHR_draco_mesh_compression)) throw new NotDrawable('noDraco');
  file.views = await openViews(file, await openBuffers(file, open));
  const { firstOf, vertexCount } = numberVertices(file, primitives);
  const shapes = new Map(primitives.map((primitive) => {
    const { POSITION, NORMAL } = primitive.attributes;
    const positions = readAccessor(file, POSITION, Float32Array);
    return [primitive, {
      positions, triangles: trianglesOf(file, primitive, positions.length / 3), first: firstOf.get(POSITION) ?? 0,
      normals: NORMAL === undefined ? null : readAccessor(file, NORMAL, Float32Array),
    }];
  }));
  const instances = instancesOf(json);
  const drawn = instances.length > 0 ? instances : (json.meshes ?? []).map((_, mesh) => ({ mesh, matrix: IDENTITY }));
  const pieces = drawn.flatMap(({ mesh, matrix }) => json.meshes[mesh].primitives.filter(isDrawn).map((primitive) => ({ ...shapes.get(primitive), matrix })));
  return { pieces, vertexCount };
}
