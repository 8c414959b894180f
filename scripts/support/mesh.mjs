// SPDX-License-Identifier: MIT
// The triangle meshes that the pictures show, read from the plain binary PLY that quadmark/lab writes.

const HEADER = new RegExp(`^${[
  'ply', 'format binary_little_endian 1\\.0',
  'element vertex (\\d+)', 'property float x', 'property float y', 'property float z',
  'element face (\\d+)', 'property list uchar int vertex_indices', 'end_header', '',
].join('\n')}$`);

/** @return { positions: Float64Array (x, y, z per vertex), faces: Uint32Array (three vertices per face) } */
export function readPly(bytes) {
  const file = Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const end = file.indexOf('end_header\n') + 'end_header\n'.length;
  const [, vertices, faces] = file.toString('latin1', 0, end).match(HEADER)?.map(Number) ?? [];
  if (vertices === undefined) throw new Error('not a PLY file as quadmark/lab writes it');
  const mesh = { positions: new Float64Array(vertices * 3), faces: new Uint32Array(faces * 3) };
  let at = end;
  for (let i = 0; i < vertices * 3; ++i, at += 4) mesh.positions[i] = file.readFloatLE(at);
  for (let f = 0; f < faces; ++f) {
    if (file[at++] !== 3) throw new Error(`face ${f} is not a triangle`);
    for (let i = 0; i < 3; ++i, at += 4) mesh.faces[f * 3 + i] = file.readInt32LE(at);
  }
  return mesh;
}

/** Unit normals per vertex, the faces around it weighted by their areas. */
export function vertexNormals({ positions: p, faces }) {
  const normals = new Float64Array(p.length);
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [faces[f] * 3, faces[f + 1] * 3, faces[f + 2] * 3];
    const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const v of [a, b, c]) for (let i = 0; i < 3; ++i) normals[v + i] += n[i];
  }
  for (let v = 0; v < normals.length; v += 3) {
    const length = Math.sqrt(normals[v] ** 2 + normals[v + 1] ** 2 + normals[v + 2] ** 2) || 1;
    for (let i = 0; i < 3; ++i) normals[v + i] /= length;
  }
  return normals;
}

/** @return { low, high, centre: [x, y, z], diagonal } of the axis-parallel bounding box */
export function bounds({ positions }) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  positions.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  const centre = low.map((value, i) => (value + high[i]) / 2);
  return { low, high, centre, diagonal: Math.sqrt(low.reduce((sum, value, i) => sum + (high[i] - value) ** 2, 0)) };
}
