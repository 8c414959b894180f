// SPDX-License-Identifier: MIT
// The JSON of a glTF, and where its nodes put its meshes.

export const IDENTITY = Float64Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
const GLB_JSON = 20, CHUNK_HEAD = 8;

/** { json, bin } of a .gltf or .glb. */
export function documentOf(bytes) {
  if (new TextDecoder('latin1').decode(bytes.subarray(0, 4)) !== 'glTF') return { json: JSON.parse(new TextDecoder().decode(bytes)), bin: null };
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const jsonEnd = GLB_JSON + view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(GLB_JSON, jsonEnd)));
  return { json, bin: jsonEnd + CHUNK_HEAD <= bytes.length ? bytes.subarray(jsonEnd + CHUNK_HEAD) : null };
}

function multiply(a, b) {
  const out = new Float64Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      for (let k = 0; k < 4; ++k) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return out;
}

function localMatrix({ matrix, translation: [tx, ty, tz] = [0, 0, 0], rotation: [x, y, z, w] = [0, 0, 0, 1], scale: [sx, sy, sz] = [1, 1, 1] }) {
  if (matrix) return Float64Array.from(matrix);
  return Float64Array.of(
    (1 - 2 * (y * y + z * z)) * sx, 2 * (x * y + z * w) * sx, 2 * (x * z - y * w) * sx, 0,
    2 * (x * y - z * w) * sy, (1 - 2 * (x * x + z * z)) * sy, 2 * (y * z + x * w) * sy, 0,
    2 * (x * z + y * w) * sz, 2 * (y * z - x * w) * sz, (1 - 2 * (x * x + y * y)) * sz, 0,
    tx, ty, tz, 1);
}

/** [{ mesh, matrix }] of the nodes that the default scene shows; without scenes, of all nodes. */
export function instancesOf(json) {
  const nodes = json.nodes ?? [];
  const children = new Set(nodes.flatMap((node) => node.children ?? []));
  const roots = json.scenes?.[json.scene ?? 0]?.nodes ?? nodes.map((_, i) => i).filter((i) => !children.has(i));
  const found = [];
  const seen = new Set();  // a broken file may go round in circles
  const waiting = roots.map((node) => [node, IDENTITY]);
  while (waiting.length > 0) {
    const [index, parent] = waiting.pop();
    if (seen.has(index) || !nodes[index]) continue;
    seen.add(index);
    const matrix = multiply(parent, localMatrix(nodes[index]));
    // A skinned mesh stands where its joints are; at rest that is its own space, nearly always.
    if (nodes[index].mesh !== undefined) found.push({ mesh: nodes[index].mesh, matrix: nodes[index].skin === undefined ? matrix : IDENTITY });
    for (const child of nodes[index].children ?? []) waiting.push([child, matrix]);
  }
  return found;
}
