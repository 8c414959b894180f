// SPDX-License-Identifier: MIT
// Makes the pictures of models and marks for the README, docs/images/, from nothing but our own code, and prints the
// numbers that go with them. Needs the built package (scripts/setup.sh, then the preset "wasm"):
//   node scripts/pictures.mjs
// The pictures of the page come from js_tests/page_pictures.mjs.
import { createHash } from 'node:crypto';
import { mkdirSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { createKey, embed, extract, parseKey } from 'quadmark';
import { attack, generate } from 'quadmark/lab';
import { drawEmblem } from './support/emblem.mjs';
import { drawScale, heat } from './support/heat.mjs';
import { bounds, readPly } from './support/mesh.mjs';
import { encodePicture } from './support/png.mjs';
import { frame, unit } from './support/raster.mjs';
import { photograph } from './support/studio.mjs';

const folder = resolve(dirname(fileURLToPath(import.meta.url)), '../docs/images');
const SIZE = 640, LOGO = 90, ENLARGED = 3;
const CLAY = [0.66, 0.37, 0.215];  // reflected share of the light
const FULL_SCALE = 5e-4;         // displacement of the last colour, as a fraction of the diagonal

const percent = (part, whole) => `${((100 * part) / whole).toFixed(1)} %`;

function write(name, width, height, rgba, facts, colours) {
  const png = encodePicture(width, height, rgba, colours);
  writeFileSync(join(folder, name), png);
  console.log(`docs/images/${name}: ${facts}; ${width} x ${height}, ${(png.length / 1000).toFixed(1)} kB`);
}

/** Ink black on white, unread pixels mid grey, each pixel enlarged. */
function writeLogo(name, { width, bits, erased }, facts) {
  const size = width * ENLARGED, rgba = Buffer.alloc(size * size * 4, 255);
  for (let at = 0; at < size * size; ++at) {
    const pixel = Math.floor(Math.floor(at / size) / ENLARGED) * width + Math.floor((at % size) / ENLARGED);
    rgba.fill(erased?.[pixel] ? 128 : bits[pixel] ? 0 : 255, at * 4, at * 4 + 3);
  }
  write(name, size, size, rgba, facts);
}

function displacements(before, after, diagonal) {
  const d = new Float64Array(before.positions.length / 3);
  for (let v = 0; v < d.length; ++v) {
    const [x, y, z] = [0, 1, 2].map((i) => after.positions[v * 3 + i] - before.positions[v * 3 + i]);
    d[v] = Math.sqrt(x * x + y * y + z * z) / diagonal;
  }
  return d;
}

// 1. Mark the sculpture. The secret is the hash of a sentence, so that each run makes the same pictures.
mkdirSync(folder, { recursive: true });
const logo = drawEmblem(LOGO);
const key = await parseKey({
  ...await createKey({ owner: 'the pictures', width: LOGO, height: LOGO }),
  secret: createHash('sha256').update('the public key of the pictures of quadmark').digest('base64'),
});
const original = await generate({ name: 'sculpture', vertices: 35000, format: 'ply' });
const marked = await embed(original.bytes, { key, image: logo });
const { distortion, cells, payloadBits, leastRepeats } = marked.report;

// 2. The model before, after, and the difference, from one place.
const before = readPly(original.bytes), after = readPly(marked.bytes), { centre, diagonal } = bounds(before);
const camera = { ...frame(unit([0.12, 0.2, 1])), centre, halfWidth: diagonal * 0.362, distance: diagonal * 2.2 };
const clay = (light, shine) => CLAY.map((share, i) => share * light[i] + shine[i]);
const beforeRgba = photograph(before, camera, SIZE, clay), afterRgba = photograph(after, camera, SIZE, clay);
const onWhite = (rgba, at, i) => 255 + ((rgba[at + i] - 255) * rgba[at + 3]) / 255;
let differing = 0, pixels = 0, squares = 0;
for (let at = 0; at < beforeRgba.length; at += 4) {
  if (beforeRgba[at + 3] === 0 && afterRgba[at + 3] === 0) continue;
  ++pixels;
  const levels = [0, 1, 2].map((i) => Math.abs(onWhite(beforeRgba, at, i) - onWhite(afterRgba, at, i)));
  if (Math.max(...levels) > 8) ++differing;
  squares += levels.reduce((sum, level) => sum + level * level, 0) / 3;
}
write('model-before.png', SIZE, SIZE, beforeRgba, `the original, ${original.vertices} vertices, ${original.faces} faces`);
write('model-after.png', SIZE, SIZE, afterRgba,
  `marked with ${payloadBits} bits in ${cells} cells (each bit at least ${leastRepeats} times), ` +
  `SNR ${distortion.snrDb.toFixed(1)} dB, normals off by ${distortion.meanNormalDeg.toFixed(2)} degrees on average; ` +
  `colours off by ${Math.sqrt(squares / pixels).toFixed(1)} of 255 (RMS), ` +
  `${percent(differing, pixels)} of the pixels by more than 8`);

const moved = displacements(before, after, diagonal);
const sorted = Float64Array.from(moved).sort();
const heatRgba = photograph(before, camera, SIZE, (light, shine, shares, vertices) => {
  const value = shares.reduce((sum, share, k) => sum + share * moved[vertices[k]], 0) / FULL_SCALE;
  const [r, g, b] = light, grey = 0.35 + 0.5 * (0.21 * r + 0.72 * g + 0.07 * b);
  return heat(value).map((part) => part * grey);
});
const keep = drawScale(heatRgba, SIZE, ['0', '≥ 0.05 %']);
write('model-difference.png', SIZE, SIZE, heatRgba,
  `displacement per vertex, colours from 0 to ${FULL_SCALE * 100} % of the diagonal and beyond: ` +
  `RMS ${(distortion.rmsRel * 100).toFixed(3)} %, median ${(sorted[sorted.length >> 1] * 100).toFixed(3)} %, ` +
  `largest ${(distortion.maxRel * 100).toFixed(2)} %, ` +
  `${percent(moved.filter((d) => d >= FULL_SCALE).length, moved.length)} of the vertices at the last colour, ` +
  `${percent(moved.filter((d) => d === 0).length, moved.length)} not moved`, { count: 128, keep });

// 3. The logo, and what is read back.
writeLogo('logo.png', logo, `what went in, ${LOGO} x ${LOGO} pixels, ${logo.bits.reduce((sum, bit) => sum + bit, 0)} of ink`);
for (const [name, what, ...steps] of [
  ['logo-reordered-affine.png', 'rotated, scaled, sheared, mirrored and reordered',
    { kind: 'affine', variant: 'CB' }, { kind: 'reorder', seed: 7 }],
  ['logo-crop50.png', 'half of the vertices cut off', { kind: 'crop', amount: 0.5 }],
  ['logo-crop92.png', '92 % of the vertices cut off', { kind: 'crop', amount: 0.92 }],
]) {
  let damaged = { bytes: marked.bytes };
  for (const step of steps) damaged = await attack(damaged.bytes, { ...step, format: 'ply' });
  const { verdict, falsePositive, image } = await extract(damaged.bytes, { key });
  const unread = image.erased.reduce((sum, flag) => sum + flag, 0);
  const wrong = image.bits.reduce((sum, bit, i) => sum + (!image.erased[i] && bit !== logo.bits[i] ? 1 : 0), 0);
  // As everywhere in this project, an unread pixel counts as half an error: that is what guessing would give.
  const ber = (wrong + unread / 2) / image.bits.length;
  writeLogo(name, image, `${what}, ${damaged.after.vertices} vertices: ${verdict}, ` +
    `probability of chance at most ${falsePositive.toExponential(1)}; ` +
    `${unread} of ${image.bits.length} pixels unread (${percent(unread, image.bits.length)}), ` +
    `${wrong} of the others wrong, BER ${percent(ber, 1)}`);
}
