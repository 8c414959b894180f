// SPDX-License-Identifier: MIT
// A PNG writer and reader of our own for the tests, so that pictures are checked independently of the core's codec.
// Writes 8-bit grey; reads grey of 1 or 8 bits with any filter.
import { crc32 as zlibCrc32, deflateSync, inflateSync } from 'node:zlib';

export const SIGNATURE = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);

function crc32(bytes) {
  if (zlibCrc32) return zlibCrc32(bytes);
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

export function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
  const result = Buffer.alloc(body.length + 8);
  result.writeUInt32BE(data.length, 0);
  body.copy(result, 4);
  result.writeUInt32BE(crc32(body), body.length + 4);
  return result;
}

/**
 * @param levels   width * height values 0 (black) to 255
 * @param claimed  the size to write into the header instead, for files that lie
 */
export function writePng(width, height, levels, claimed = { width, height }) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(claimed.width, 0);
  header.writeUInt32BE(claimed.height, 4);
  header[8] = 8;  // bits; colour type 0 = grey
  const rows = Buffer.alloc(height * (width + 1));
  for (let y = 0; y < height; ++y) Buffer.from(levels.slice(y * width, (y + 1) * width)).copy(rows, y * (width + 1) + 1);
  return Buffer.concat([SIGNATURE, chunk('IHDR', header), chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}

/** @return { width, height, levels } with levels 0 to 255 */
export function readPng(bytes) {
  const file = Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (!file.subarray(0, 8).equals(SIGNATURE)) throw new Error('not a PNG');
  let at = 8, header;
  const data = [];
  while (at < file.length) {
    const length = file.readUInt32BE(at);
    const type = file.toString('latin1', at + 4, at + 8);
    const body = file.subarray(at + 8, at + 8 + length);
    if (file.readUInt32BE(at + 8 + length) !== crc32(file.subarray(at + 4, at + 8 + length))) throw new Error(`${type}: bad CRC`);
    if (type === 'IHDR') header = body;
    if (type === 'IDAT') data.push(body);
    at += length + 12;
  }
  const width = header.readUInt32BE(0), height = header.readUInt32BE(4), bits = header[8], colour = header[9];
  if (colour !== 0 || (bits !== 1 && bits !== 8)) throw new Error(`colour type ${colour} of ${bits} bits`);
  const rows = inflateSync(Buffer.concat(data));
  const stride = Math.ceil((width * bits) / 8);
  const levels = new Uint8Array(width * height);
  let above = new Uint8Array(stride);
  for (let y = 0; y < height; ++y) {
    const filter = rows[y * (stride + 1)];
    const row = Uint8Array.from(rows.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1)));
    for (let x = 0; x < stride; ++x) {
      const a = x > 0 ? row[x - 1] : 0, b = above[x], c = x > 0 ? above[x - 1] : 0;
      const p = a + b - c;
      const paeth = Math.abs(p - a) <= Math.abs(p - b) && Math.abs(p - a) <= Math.abs(p - c) ? a : Math.abs(p - b) <= Math.abs(p - c) ? b : c;
      row[x] += [0, a, b, (a + b) >> 1, paeth][filter];
    }
    for (let x = 0; x < width; ++x) levels[y * width + x] = bits === 8 ? row[x] : ((row[x >> 3] >> (7 - (x & 7))) & 1) * 255;
    above = row;
  }
  return { width, height, levels };
}
