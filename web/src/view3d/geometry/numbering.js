// SPDX-License-Identifier: MIT
// Which vertex of the core's mesh an element of a POSITION accessor is (core/src/io/gltf_arrays.cpp): arrays follow one
// another in the order of their first use, accessors that are windows onto the same bytes share vertices, the values of
// a sparse accessor are an array of their own, and zeros that are stored nowhere are one vertex per accessor, at the end.
import { componentBytes, readSparseIndices } from './accessors.js';

/** Equally spaced elements, as the core groups them. */
function layoutOf({ json }, accessor, { bufferView, byteOffset = 0 }, count, isPacked) {
  const view = json.bufferViews[bufferView];
  const width = 3 * componentBytes(accessor.componentType);
  const stride = (!isPacked && view.byteStride) || width;
  const compressed = view.extensions?.EXT_meshopt_compression || view.extensions?.KHR_meshopt_compression;
  const { uri = 'data:' } = json.buffers[view.buffer] ?? {};
  const buffer = uri.startsWith('data:') ? view.buffer : json.buffers.findIndex((other) => other.uri === uri);  // two may name one file
  const start = compressed ? byteOffset : (view.byteOffset ?? 0) + byteOffset;
  return {
    place: compressed ? `view ${bufferView}` : `buffer ${buffer}`, start, stride, width, count,
    kind: [stride, start % stride, accessor.componentType, accessor.normalized ?? false].join(),
  };
}

/** Gives each layout the array that it is a window of. */
function joinWindows(layouts) {
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
}

const firstOf = ({ array, start, stride }) => array.first + (start - array.start) / stride;

/**
 * @param file        { json, views } with Draco's data in place
 * @param primitives  those that are drawn
 * @return {{ numbersOf: Map<number, Uint32Array>, vertexCount: number }}  numbers by POSITION accessor
 */
export function numberVertices(file, primitives) {
  const { accessors } = file.json;
  const windows = [...new Set(primitives.map(({ attributes }) => attributes.POSITION))].map((index) => {
    const accessor = accessors[index], { bufferView, sparse, count } = accessor;
    return {
      index, accessor,
      base: bufferView === undefined ? null : layoutOf(file, accessor, accessor, count, false),
      values: sparse ? layoutOf(file, accessor, sparse.values, sparse.count, true) : null,
    };
  });
  const layouts = windows.flatMap(({ base, values }) => [base, values].filter(Boolean));
  joinWindows(layouts);
  let vertexCount = 0;
  for (const { array } of layouts) {
    if (array.first !== null) continue;
    array.first = vertexCount;
    vertexCount += array.count;
  }
  const numbersOf = new Map(windows.map(({ index, accessor, base, values }) => {
    const zeros = base ? null : vertexCount++;
    const numbers = Uint32Array.from({ length: accessor.count }, (_, i) => (base ? firstOf(base) + i : zeros));
    if (values) readSparseIndices(file, accessor).forEach((element, i) => { numbers[element] = firstOf(values) + i; });
    return [index, numbers];
  }));
  return { numbersOf, vertexCount };
}
