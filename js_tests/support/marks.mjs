// SPDX-License-Identifier: MIT
// Watermark images and generated models for the tests.
import { createKey } from 'quadmark';
import { generate } from 'quadmark/lab';
import { writePng } from './png.mjs';

/** A drawing without symmetry: a ring with a tail and a dot, so that a turned or mirrored picture is noticed. */
export function logo(width = 24, height = width) {
  const bits = new Uint8Array(width * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const u = (x + 0.5) / width - 0.5, v = (y + 0.5) / height - 0.5;
      const r2 = u * u + v * v;
      const ring = r2 < 0.17 && r2 > 0.07;
      const tail = u > 0.08 && v > 0.08 && Math.abs(u - v) < 0.09;
      const dot = (u + 0.4) * (u + 0.4) + (v + 0.4) * (v + 0.4) < 0.006;
      bits[y * width + x] = ring || tail || dot ? 1 : 0;
    }
  }
  return { width, height, bits };
}

export const logoPng = (image) => writePng(image.width, image.height, Array.from(image.bits, (bit) => (bit ? 0 : 255)));

/** A key for a square logo that is the same in every run, for tests of how much changes. */
export const fixedKey = async (size, options = {}) =>
  ({ ...(await createKey({ width: size, height: size, ...options })), secret: Buffer.alloc(32, 'for tests').toString('base64') });

/** The bits of `image` as base64, row-major, most significant bit first: what the reports hold. */
export function packBits({ bits }) {
  const packed = Buffer.alloc(Math.ceil(bits.length / 8));
  bits.forEach((bit, i) => { packed[i >> 3] |= bit << (7 - (i & 7)); });
  return packed.toString('base64');
}

/** A detailed model with room for 24 x 24 pixels many times over. */
export const sculpture = async (format = 'ply', vertices = 6000) =>
  (await generate({ name: 'sculpture', vertices, format })).bytes;
