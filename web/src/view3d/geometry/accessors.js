// SPDX-License-Identifier: MIT
// Elements of glTF accessors, out of buffer views that are there already.

const COMPONENTS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
const DIVISORS = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };

export const componentBytes = (componentType) => COMPONENTS[componentType].BYTES_PER_ELEMENT;

/** `length` components at `offset` of a view: an aligned copy, for views may begin anywhere in a GLB. */
function componentsAt(view, offset, componentType, length) {
  return new COMPONENTS[componentType](view.slice(offset, offset + length * componentBytes(componentType)).buffer);
}

/** The elements that a sparse accessor replaces. */
export function readSparseIndices({ views }, { sparse: { count, indices } }) {
  return componentsAt(views[indices.bufferView], indices.byteOffset ?? 0, indices.componentType, count);
}

/** Elements of an accessor as `Target`, sparse values in their places, normalized integers divided. */
export function readAccessor(file, index, Target) {
  const { json, views } = file;
  const accessor = json.accessors[index];
  const { componentType, bufferView, byteOffset = 0, count: all, sparse } = accessor;
  const width = WIDTHS[accessor.type];
  const divisor = accessor.normalized ? DIVISORS[componentType] : 1;
  const out = new Target(all * width);
  const copy = (view, offset, step, count, place) => {
    const values = componentsAt(view, offset, componentType, (count - 1) * step + width);
    for (let i = 0; i < count; ++i) {
      for (let axis = 0; axis < width; ++axis) out[place(i) * width + axis] = values[i * step + axis] / divisor;
    }
  };
  if (bufferView !== undefined) {
    const stride = json.bufferViews[bufferView].byteStride;
    copy(views[bufferView], byteOffset, stride ? stride / componentBytes(componentType) : width, all, (i) => i);
  }
  if (sparse) {
    const places = readSparseIndices(file, accessor);
    copy(views[sparse.values.bufferView], sparse.values.byteOffset ?? 0, width, sparse.count, (i) => places[i]);
  }
  return out;
}
