// SPDX-License-Identifier: MIT
// PLY as triangles: ascii and both binary byte orders, polygons as fans, triangle strips opened.
import { IDENTITY } from './gltf_scene.js';

const SIZES = { char: 1, uchar: 1, short: 2, ushort: 2, int: 4, uint: 4, float: 4, double: 8 };
const ALIASES = { int8: 'char', uint8: 'uchar', int16: 'short', uint16: 'ushort', int32: 'int', uint32: 'uint', float32: 'float', float64: 'double' };
const READERS = { char: 'getInt8', uchar: 'getUint8', short: 'getInt16', ushort: 'getUint16', int: 'getInt32', uint: 'getUint32', float: 'getFloat32', double: 'getFloat64' };
const plain = (type) => ALIASES[type] ?? type;

function parseHeader(bytes) {
  const text = new TextDecoder('latin1').decode(bytes.subarray(0, 1 << 16));
  const end = /(^|\n)end_header[ \t]*\r?\n/.exec(text);
  const elements = [];
  let format = 'ascii';
  for (const line of text.slice(0, end.index).split(/\r?\n/)) {
    const words = line.trim().split(/\s+/);
    if (words[0] === 'format') [, format] = words;
    if (words[0] === 'element') elements.push({ name: words[1], count: Number(words[2]), properties: [] });
    if (words[0] !== 'property') continue;
    const list = words[1] === 'list';
    elements.at(-1).properties.push({ name: words.at(-1), type: plain(words.at(-2)), count: list ? plain(words[2]) : null });
  }
  return { format, elements, body: end.index + end[0].length };
}

/** Numbers of the body one after another, each asked for by its type. */
function numberReader(bytes, { format, body }) {
  if (format === 'ascii') {
    let at = body;
    const isSpace = (byte) => byte <= 32;
    return () => {
      while (isSpace(bytes[at])) ++at;
      const start = at;
      while (at < bytes.length && !isSpace(bytes[at])) ++at;
      return Number(String.fromCharCode.apply(null, bytes.subarray(start, at)));
    };
  }
  const little = format === 'binary_little_endian';
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = body;
  return (type) => {
    const value = view[READERS[type]](at, little);
    at += SIZES[type];
    return value;
  };
}

function addFan(triangles, corners) {
  for (let i = 2; i < corners.length; ++i) triangles.push(corners[0], corners[i - 1], corners[i]);
}

/** A strip; -1 begins another. */
function addStrip(triangles, corners) {
  let start = 0;
  corners.forEach((corner, i) => {
    if (corner === -1) start = i + 1;
    else if (i - start >= 2) triangles.push(...((i - start) % 2 === 0 ? [corners[i - 2], corners[i - 1]] : [corners[i - 1], corners[i - 2]]), corner);
  });
}

/** Reads a PLY; see readGeometry(). */
export function readPly(bytes) {
  const header = parseHeader(bytes);
  const next = numberReader(bytes, header);
  let positions = new Float32Array();
  const triangles = [];
  for (const { name, count, properties } of header.elements) {
    if (name === 'vertex') positions = new Float32Array(3 * count);
    const axes = properties.map((property) => (name === 'vertex' ? ['x', 'y', 'z'].indexOf(property.name) : -1));
    for (let i = 0; i < count; ++i) {
      for (let p = 0; p < properties.length; ++p) {
        const { name: property, type, count: countType } = properties[p];
        if (countType === null) {
          const value = next(type);
          if (axes[p] >= 0) positions[3 * i + axes[p]] = value;
          continue;
        }
        const values = [];
        for (let left = next(countType); left > 0; --left) values.push(next(type));
        if (name === 'face' && /^vertex_ind(ex|ices)$/.test(property)) addFan(triangles, values);
        if (name === 'tristrips' && /^vertex_ind(ex|ices)$/.test(property)) addStrip(triangles, values);
      }
    }
  }
  const vertexCount = positions.length / 3;
  const numbers = Uint32Array.from({ length: vertexCount }, (_, i) => i);
  return { pieces: [{ positions, triangles: Uint32Array.from(triangles), normals: null, numbers, matrix: IDENTITY }], vertexCount };
}
