// SPDX-License-Identifier: MIT
// Watermark images and generated models for the tests.
import { createKey } from 'quadmark';
import { generate } from 'quadmark/lab';
import { drawEmblem } from '../../scripts/support/emblem.mjs';
import { writePng } from './png.mjs';

export const logo = (width = 24, height = width) => drawEmblem(width, height);

export const logoPng = (image) => writePng(image.width, image.height, Array.from(image.bits, (bit) => (bit ? 0 : 255)));

/** A key for a square logo that is the same in every run, for tests of how much changes. */
export const fixedKey = async (size, options = {}) =>
  ({ ...(await createKey({ width: size, height: size, ...options })), secret: Buffer.alloc(32, 'for tests').toString('base64') });

/** A key of scheme robust that is the same in every run: on small models the margin of a reading varies with the key. */
export const fixedRobustKey = async () => ({ ...(await createKey()), secret: Buffer.alloc(32, 'for tests').toString('base64') });

/** The bits of `image` as base64, row-major, most significant bit first: what the reports hold. */
export function packBits({ bits }) {
  const packed = Buffer.alloc(Math.ceil(bits.length / 8));
  bits.forEach((bit, i) => { packed[i >> 3] |= bit << (7 - (i & 7)); });
  return packed.toString('base64');
}

/** A detailed model with room for 24 x 24 pixels many times over. */
export const sculpture = async (format = 'ply', vertices = 6000) =>
  (await generate({ name: 'sculpture', vertices, format })).bytes;
