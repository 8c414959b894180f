// SPDX-License-Identifier: MIT
// What a tool made of a model, found in the file it wrote: whether it did what its command line says.
import { attack } from 'quadmark/lab';
import { decodeDraco } from '../../../js_tests/support/draco.mjs';
import { isGlb, openGltf } from '../../../js_tests/support/gltf.mjs';
import { readDocument } from '../../../js_tests/support/gltf_readers.mjs';

const FLOAT_BITS = 20;  // finer than this is float32; six decimals of a small model are a grid of 18 bits

/** The positions of a PLY that our laboratory wrote. */
function positionsOfPly(ply) {
  const bytes = Buffer.from(ply), end = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const head = bytes.toString('latin1', 0, end);
  const count = 3 * Number(head.match(/element vertex (\d+)/)[1]);
  const [size, read] = /property double x/.test(head) ? [8, 'readDoubleLE'] : [4, 'readFloatLE'];
  return Float64Array.from({ length: count }, (_, i) => bytes[read](end + size * i));
}

function glTFTransformCannotRead(model) {
  const { extensionsUsed = [], images = [] } = openGltf(model).json;
  return extensionsUsed.includes('KHR_meshopt_compression') || images.some(({ uri }) => uri && !uri.startsWith('data:'));
}

/** Positions, x y z x y z ..., one array for each primitive or one for all. */
async function positionsOf(model) {
  if (Buffer.from(model).toString('latin1', 0, 5) === 'DRACO') return [decodeDraco(model)];
  if (!isGlb(model) || glTFTransformCannotRead(model)) {
    return [positionsOfPly((await attack(model, { kind: 'noise', amount: 0, format: 'ply' })).bytes)];
  }
  const primitives = (await readDocument(model)).getRoot().listMeshes().flatMap((mesh) => mesh.listPrimitives());
  return [...new Set(primitives.map((primitive) => primitive.getAttribute('POSITION')))].map((accessor) => {
    const out = new Float64Array(3 * accessor.getCount()), place = [];
    for (let i = 0; i < accessor.getCount(); ++i) out.set(accessor.getElement(i, place), 3 * i);
    return out;
  });
}

const extensionsOf = (model) => (isGlb(model) ? openGltf(model).json.extensionsUsed ?? [] : []);

/** Distinct positions: a seam or a triangle soup repeats them. */
function distinct(arrays) {
  const seen = new Set();
  for (const array of arrays) for (let i = 0; i < array.length; i += 3) seen.add(`${array[i]} ${array[i + 1]} ${array[i + 2]}`);
  return seen.size;
}

/** Bits of the grid that the coordinates along the longest side lie on, from the smallest step between two; null for float32. */
function gridBits(array) {
  const axes = [0, 1, 2].map((axis) => array.filter((_, i) => i % 3 === axis).sort());
  const sides = axes.map((values) => values.at(-1) - values[0]);
  const side = Math.max(...sides), values = axes[sides.indexOf(side)];
  let step = side;
  for (let i = 1; i < values.length; ++i) {
    const gap = values[i] - values[i - 1];
    if (gap > side * 2 ** -22 && gap < step) step = gap;  // smaller ones are the same level, rounded twice
  }
  const bits = Math.log2(Math.round(side / step) + 1);
  return bits > FLOAT_BITS ? null : Math.ceil(bits - 0.1);  // the smallest step is a little too small: float32 rounds
}

/** { vertices, bits, extensions } of a model. */
export async function describeModel(model) {
  const arrays = await positionsOf(model);
  const grids = arrays.filter((array) => array.length > 0).map(gridBits);
  return { vertices: distinct(arrays), bits: grids.includes(null) ? null : Math.max(...grids), extensions: extensionsOf(model) };
}

/** As a note in the results. */
export const describe = (made, before) =>
  `${made.vertices} of ${before.vertices} vertices${made.bits === null ? '' : `, ${made.bits} bits`}`;

/** What is not as `expects` (lines.mjs) wants it, or null. */
export function disappointment({ bits, uses, removes } = {}, made, before) {
  if (bits && (made.bits === null || made.bits > bits)) return `its positions are finer than ${bits} bits`;
  if (uses && !uses.some((name) => made.extensions.includes(name))) return `what it wrote does not use ${uses.join(' or ')}`;
  if (removes && made.vertices >= before.vertices) return 'it removed no vertex';
  return null;
}
