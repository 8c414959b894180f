// SPDX-License-Identifier: MIT
// Writes small PNG files: a palette of at most 256 colours and opacities, and the filters that suit it best.
import { deflateSync } from 'node:zlib';
import { chunk, SIGNATURE } from '../../js_tests/support/png.mjs';

function paeth(a, b, c) {
  const p = a + b - c, da = Math.abs(p - a), db = Math.abs(p - b), dc = Math.abs(p - c);
  return da <= db && da <= dc ? a : db <= dc ? b : c;
}

/** Filter 0 to 4 per row by the usual rule, the least sum of absolute residuals; or `only` for all rows. */
function filterRows(pixels, stride, step, only) {
  const height = pixels.length / stride, rows = Buffer.alloc(height * (stride + 1));
  let above = new Uint8Array(stride);
  for (let y = 0; y < height; ++y) {
    const row = pixels.subarray(y * stride, (y + 1) * stride);
    let least = Infinity;
    for (const filter of only === undefined ? [0, 1, 2, 3, 4] : [only]) {
      const out = Buffer.alloc(stride + 1);
      out[0] = filter;
      let sum = 0;
      for (let x = 0; x < stride; ++x) {
        const a = x >= step ? row[x - step] : 0, b = above[x], c = x >= step ? above[x - step] : 0;
        const guess = filter === 0 ? 0 : filter === 1 ? a : filter === 2 ? b : filter === 3 ? (a + b) >> 1 : paeth(a, b, c);
        const residual = (row[x] - guess) & 255;
        out[x + 1] = residual;
        sum += residual < 128 ? residual : 256 - residual;
      }
      if (sum < least) {
        least = sum;
        out.copy(rows, y * (stride + 1));
      }
    }
    above = row;
  }
  return rows;
}

function file(width, height, colourType, pixels, channels, middle = []) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, colourType], 8);
  // No rule knows which filters compress best: the smallest of all wins.
  const packed = [undefined, 0, 1, 2, 4]
    .map((only) => deflateSync(filterRows(pixels, width * channels, channels, only), { level: 9, memLevel: 9 }))
    .reduce((best, other) => (other.length < best.length ? other : best));
  return Buffer.concat([SIGNATURE, chunk('IHDR', header), ...middle, chunk('IDAT', packed), chunk('IEND', Buffer.alloc(0))]);
}

/**
 * @param indices  width * height numbers of entries of `palette`
 * @param palette  at most 256 entries [r, g, b, alpha]
 */
function encodePalette(width, height, indices, palette) {
  const colours = chunk('PLTE', Buffer.from(palette.flatMap((entry) => entry.slice(0, 3))));
  const opacities = chunk('tRNS', Buffer.from(palette.map((entry) => entry[3])));
  return file(width, height, 3, indices, 1, [colours, opacities]);
}

/**
 * A picture in at most `count` colours, found by median cut: the group of colours that spreads widest, weighted by its
 * pixels, is cut in two at its median until there are enough.
 * @param rgba   width * height * 4 bytes, straight alpha
 * @param count  at most 256
 * @param keep   colours (the four bytes as one number, big endian) that get an entry of their own
 */
export function encodePicture(width, height, rgba, { count = 256, keep = [] } = {}) {
  const pixels = new Map();
  for (let at = 0; at < rgba.length; at += 4) {
    const colour = rgba.readUInt32BE(at);
    pixels.set(colour, (pixels.get(colour) ?? 0) + 1);
  }
  const entries = [...pixels].map(([colour, weight]) => (
    { colour, weight, parts: [colour >>> 24, (colour >>> 16) & 255, (colour >>> 8) & 255, colour & 255] }));
  const measure = (members) => {
    const weight = members.reduce((sum, entry) => sum + entry.weight, 0);
    const spreads = [0, 1, 2, 3].map((i) => {
      const mean = members.reduce((sum, entry) => sum + entry.weight * entry.parts[i], 0) / weight;
      return members.reduce((sum, entry) => sum + entry.weight * (entry.parts[i] - mean) ** 2, 0);
    });
    const axis = spreads.indexOf(Math.max(...spreads));
    return { members, weight, axis, spread: spreads[axis] };
  };
  const kept = new Set(keep), isKept = ({ colour }) => kept.has(colour);
  const groups = [entries.filter((entry) => !isKept(entry)), ...entries.filter(isKept).map((entry) => [entry])]
    .filter((members) => members.length > 0).map(measure);
  while (groups.length < count) {
    const widest = groups.reduce((best, group, i) => (group.spread > groups[best].spread ? i : best), 0);
    const { members, weight, axis, spread } = groups[widest];
    if (spread === 0) break;
    members.sort((a, b) => a.parts[axis] - b.parts[axis] || a.colour - b.colour);
    let cut = 0;
    for (let sum = 0; cut < members.length - 1 && (cut === 0 || sum + members[cut].weight <= weight / 2); ++cut) {
      sum += members[cut].weight;
    }
    groups.splice(widest, 1, measure(members.slice(0, cut)), measure(members.slice(cut)));
  }
  // Neighbours in the palette look alike, so that the filters find little difference between neighbouring pixels.
  const brightness = ([r, g, b, alpha]) => alpha * 1000 + 2 * r + 4 * g + b;
  const palette = groups
    .map(({ members, weight }) => {
      const sums = [0, 1, 2, 3].map((i) => members.reduce((sum, entry) => sum + entry.weight * entry.parts[i], 0));
      return { members, mean: sums.map((sum) => Math.round(sum / weight)) };
    })
    .sort((a, b) => brightness(a.mean) - brightness(b.mean));
  const numbers = new Map(palette.flatMap(({ members }, number) => members.map(({ colour }) => [colour, number])));
  const indices = new Uint8Array(width * height).map((_, i) => numbers.get(rgba.readUInt32BE(i * 4)));
  return encodePalette(width, height, indices, palette.map(({ mean }) => mean));
}
