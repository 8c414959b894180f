// SPDX-License-Identifier: MIT
// Models as triangles to draw, with each vertex's number in the core's own order, which is the order of its evidence.
import { readDrc } from './draco.js';
import { readGltf } from './gltf.js';
import { NotDrawable } from './not_drawable.js';
import { readPly } from './ply.js';

/**
 * @typedef {object} Piece
 * @property {Float32Array} positions  x, y, z per vertex, in the space of its node
 * @property {Uint32Array} triangles   three vertices each
 * @property {Float32Array | null} normals
 * @property {Uint32Array} numbers     of its vertices in the core's mesh
 * @property {Float64Array} matrix     column-major, from the node's space to the world's
 */

/**
 * @param {Uint8Array} bytes
 * @param {(uri: string) => Promise<Uint8Array>} open  external buffers
 * @param {() => Promise<object>} openDraco            Draco's decoder module
 * @return {Promise<{ pieces: Piece[], vertexCount: number }>}  vertexCount: of the core's mesh
 */
export async function readGeometry(bytes, open, openDraco) {
  const start = new TextDecoder('latin1').decode(bytes.subarray(0, 8)).replace(/^\u00ef\u00bb\u00bf/, '').trimStart();
  try {
    if (start.startsWith('DRACO')) return readDrc(await openDraco(), bytes);
    return /^ply\s/.test(start) ? readPly(bytes) : await readGltf(bytes, open, openDraco);
  } catch (error) {
    throw error instanceof NotDrawable ? error : new NotDrawable('noShape', { cause: error });
  }
}
