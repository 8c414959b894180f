// SPDX-License-Identifier: MIT
// The demonstration behind scripts/demo.sh: every step is a command as a user types it, shown before it runs.
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { decodeImage, encodeImage } from 'quadmark';
import { generate } from 'quadmark/lab';
import { drawEmblem } from './support/emblem.mjs';

const repository = resolve(dirname(fileURLToPath(import.meta.url)), '..');
const folder = join(repository, 'build/demo');
const SIZE = 24;

/** Two rows of pixels per line of text; unread pixels (mid grey) as a shade. */
function textArt(levels, width, height) {
  const lines = [];
  for (let y = 0; y < height; y += 2) {
    let line = '';
    for (let x = 0; x < width; ++x) {
      const upper = levels[y * width + x], lower = y + 1 < height ? levels[(y + 1) * width + x] : 0;
      line += upper === 2 || lower === 2 ? '░' : [' ', '▀', '▄', '█'][upper + 2 * lower];
    }
    lines.push(line);
  }
  return lines;
}

/** Runs one command in the demo's folder and returns the object that --json printed. */
function quadmark(args, { expect = [0] } = {}) {
  const shown = args.map((part) => (/^[\w./=:-]+$/.test(part) ? part : `'${part}'`)).join(' ');
  const { status, stdout, stderr } = spawnSync(
    process.execPath, [join(repository, 'node/src/cli/main.js'), ...args, '--json'], { cwd: folder, encoding: 'utf8' });
  if (!expect.includes(status)) throw new Error(`quadmark ${shown}: exit status ${status}\n${stderr}`);
  console.log(`  $ quadmark ${shown}`);
  return JSON.parse(stdout);
}

const ATTACKS = [
  ['none', null],
  ['rotate, scale, shear, mirror (CB)', ['--kind', 'affine', '--variant', 'CB']],
  ['all vertices and faces reordered', ['--kind', 'reorder', '--seed', '7']],
  ['half of the vertices cut off', ['--kind', 'crop', '--amount', '0.5']],
  ['bent and twisted', ['--kind', 'deform', '--amount', '0.5']],
  ['30 % of the faces simplified away', ['--kind', 'simplify', '--amount', '0.3', '--variant', 'meshopt']],
  ['noise of 1e-4 of the diagonal', ['--kind', 'noise', '--amount', '1e-4']],
  ['quantized to 12 bits', ['--kind', 'quantize', '--amount', '12', '--variant', 'common']],
];

/** Wrong and unread pixels for the table; dashes where there is no picture. */
const pixels = ({ ber, image }) => (image ? [`${(ber * 100).toFixed(1)} %`, image.erased ?? 0] : ['-', '-']);

function printTable(rows) {
  const widths = rows[0].map((_, column) => Math.max(...rows.map((row) => String(row[column]).length)));
  const line = (row) => row.map((cell, i) => (i === 0 ? String(cell).padEnd(widths[i]) : String(cell).padStart(widths[i]))).join('  ');
  console.log([line(rows[0]), widths.map((width) => '-'.repeat(width)).join('  '), ...rows.slice(1).map(line)].map((text) => `  ${text}`).join('\n'));
}

async function main() {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const logo = drawEmblem(SIZE);
  writeFileSync(join(folder, 'logo.png'), await encodeImage(logo));
  const model = await generate({ name: 'sculpture', vertices: 35000, format: 'glb' });
  writeFileSync(join(folder, 'sculpture.glb'), model.bytes);
  console.log(`\nA generated sculpture of ${model.vertices} vertices and a logo of ${SIZE} x ${SIZE} pixels, in build/demo:\n`);

  quadmark(['keygen', 'key.json', '--owner', 'the demo']);
  const embedded = quadmark(['embed', 'sculpture.glb', 'marked.glb', '--key', 'key.json', '--image', 'logo.png']);
  const { distortion } = embedded;
  const results = [];
  let cropped;
  ATTACKS.forEach(([what, args], i) => {
    const file = args ? `attacked-${i}.glb` : 'marked.glb';
    if (args) quadmark(['attack', 'marked.glb', file, ...args]);
    const picture = `read-${i}.png`;
    const read = quadmark(['extract', file, '--key', 'key.json', '--reference', 'logo.png', '--image-out', picture], { expect: [0, 3, 4] });
    results.push([what, read.verdict, ...pixels(read), read.falsePositive.toExponential(1)]);
    if (args?.includes('crop')) cropped = picture;
  });
  const unmarked = quadmark(['extract', 'sculpture.glb', '--key', 'key.json', '--reference', 'logo.png'], { expect: [3, 4] });
  results.push(['(the unmarked original)', unmarked.verdict, ...pixels(unmarked), unmarked.falsePositive.toExponential(1)]);

  console.log(`\nEmbedding: ${embedded.payloadBits} bits in ${embedded.cells} cells, SNR ${distortion.snrDb.toFixed(1)} dB, ` +
    `largest displacement ${distortion.maxRel.toExponential(1)} of the diagonal, ${Math.round(embedded.millis)} ms\n`);
  printTable([['What happened to the marked model', 'verdict', 'wrong bits', 'unread', 'chance of that'], ...results]);

  const left = textArt(logo.bits, SIZE, SIZE);
  const found = await decodeImage(readFileSync(join(folder, cropped)));
  const right = textArt(found.bits, SIZE, SIZE);
  console.log(`\n  ${'The logo'.padEnd(SIZE + 4)}Read back from half of the model\n`);
  left.forEach((line, i) => console.log(`  ${line}    ${right[i]}`));
  console.log('');
  if (results[0][1] !== 'match' || results[1][1] !== 'match' || unmarked.verdict !== 'none') {
    throw new Error('the demonstration did not go as it must: see the table');
  }
}

await main();
