// SPDX-License-Identifier: MIT
// Turns the lines that quadmark_robust appended into the tables of docs/robust.md, between its <!-- tables --> marks.
//
//   node bench/robust_table.mjs RESULTS.csv DOCUMENT.md
import { readFileSync, writeFileSync } from 'node:fs';

const [, , resultsPath, documentPath] = process.argv;
const KINDS = {
  'real models': (name) => !name.includes(':'),
  'generated, scan-like': (name) => /^sculpture:(8|12|20|30|40|60)000:\d+(@0\.2)?$/.test(name),
  'generated, CAD-like': (name) => /^part:\d+:\d+(@0\.2)?$/.test(name),
  'generated, height-field grids': (name) => name.startsWith('bumpy-grid'),
  'generated, subdivision surfaces': (name) => /^(quad-sphere|icosphere)/.test(name),
  'generated, low-poly': (name) => /^(sculpture:3000|.*@0\.05)/.test(name),
};
const FULL_KEYS = 5;

const marks = [], reads = [];
for (const line of readFileSync(resultsPath, 'utf8').split('\n')) {
  const [kind, model, strength, payload, key, ...rest] = line.split(';');
  const about = { model, strength, payload, key: Number(key) };
  if (kind === 'mark') {
    const [vertices, carriers, labels, cells, snr, rms, most, normals] = rest.map(Number);
    marks.push({ ...about, vertices, carriers, labels, cells, snr, rms, most, normals });
  } else if (kind === 'read') {
    const [row, outcome, layers, probability, ber] = rest;
    reads.push({ ...about, row, outcome, layers, probability: Number(probability), ber: ber === '-' ? null : Number(ber) });
  }
}

const unique = (list) => [...new Set(list)];
const mean = (list) => list.reduce((a, b) => a + b, 0) / list.length;
const table = (head, rows) => [head, head.map(() => '---'), ...rows].map((row) => `| ${row.join(' | ')} |`).join('\n');

/** Exact counts; "+n" verified, "-n" lost; layers of the exact ones. */
function cell(list) {
  if (list.length === 0) return '';
  const count = (outcome) => list.filter((r) => r.outcome === outcome).length;
  if (count('refused') === list.length) return 'refused';
  let text = String(count('exact'));
  if (count('verified')) text += `+${count('verified')}`;
  if (count('lost')) text += `-${count('lost')}`;
  if (count('failed')) text += ` (${count('failed')} failed)`;
  if (count('refused')) text += ` (${count('refused')} refused)`;
  if (count('wrong')) text += ` **${count('wrong')} WRONG**`;
  const layers = unique(list.filter((r) => r.outcome === 'exact').map((r) => r.layers)).sort().join('');
  return layers ? `${text} ${layers}` : text;
}

function writtenTable(models, payload) {
  const rows = models.flatMap((model) => {
    const of = (strength) => marks.filter((m) => m.model === model && m.payload === payload && m.strength === strength);
    const list = of('standard'), quiet = of('invisible');
    if (list.length === 0) return [];
    const avg = (name, digits, from = list) => (from.length ? mean(from.map((m) => m[name])).toFixed(digits) : '');
    return [[model, list[0].vertices, avg('carriers', 0), avg('labels', 0), avg('cells', 0), avg('snr', 1), avg('rms', 4),
      avg('most', 2), avg('normals', 2), avg('snr', 1, quiet), avg('rms', 4, quiet), avg('normals', 2, quiet)]];
  });
  const withQuiet = rows.some((row) => row[9] !== '');
  const head = ['model', 'vertices', 'carriers', 'labels', 'cells', 'SNR dB', 'surface RMS %', 'largest move %', 'normals deg',
    '`invisible`: SNR', 'RMS %', 'normals deg'];
  return withQuiet ? table(head, rows) : table(head.slice(0, 9), rows.map((row) => row.slice(0, 9)));
}

function readTable(models, select) {
  const list = reads.filter(select);
  const rows = unique(list.map((r) => r.row));
  return table(['attack', ...models],
    rows.map((row) => [row, ...models.map((model) => cell(list.filter((r) => r.row === row && r.model === model)))]));
}

const parts = [];
const standardId = (r) => r.payload === 'id' && r.strength === 'standard';
const all = unique(reads.filter(standardId).map((r) => r.model));
const keysOf = (select) => {
  const list = reads.filter(select), models = unique(list.map((r) => r.model));
  const numbers = models.map((model) => unique(list.filter((r) => r.model === model).map((r) => r.key)).length);
  const least = Math.min(...numbers), most = Math.max(...numbers);
  return `${least === most ? most : `${least} to ${most}`} key${most === 1 ? '' : 's'} per model${least < FULL_KEYS ? ` (a partial run: ${FULL_KEYS} are meant)` : ''}`;
};

parts.push(`### 64-bit IDs at \`standard\`: ${keysOf(standardId)}\n`);
for (const [kind, belongs] of Object.entries(KINDS)) {
  const models = all.filter(belongs);
  if (models.length === 0) continue;
  parts.push(`**${kind}**\n`, writtenTable(models, 'id') + '\n', readTable(models, standardId) + '\n');
}

const isImage = (r) => r.payload === 'image';
if (reads.some(isImage)) {
  const models = unique(reads.filter(isImage).map((r) => r.model));
  parts.push(`### Images of 24 x 24 pixels at \`standard\`: ${keysOf(isImage)}\n`, writtenTable(models, 'image') + '\n',
    readTable(models, isImage) + '\n');
  const left = reads.filter((r) => isImage(r) && r.outcome === 'verified' && r.ber !== null);
  if (left.length) {
    parts.push(`Of those that were recognised only, the share of wrong pixels: ${unique(left.map((r) => r.row)).map((row) =>
      `${row} ${unique(left.filter((r) => r.row === row).map((r) => r.model)).map((model) =>
        `${model} ${(100 * mean(left.filter((r) => r.row === row && r.model === model).map((r) => r.ber))).toFixed(1)} %`).join(', ')}`).join('; ')}.\n`);
  }
}

const wrong = reads.filter((r) => r.outcome === 'wrong').length;
parts.push(`Readings in these tables: ${reads.length}; of a wrong payload: ${wrong}.\n`);

const before = readFileSync(documentPath, 'utf8');
const after = before.replace(/(<!-- tables -->\n)[\s\S]*(<!-- \/tables -->)/, (_, open, close) => `${open}\n${parts.join('\n')}\n${close}`);
if (after === before && !before.includes('<!-- tables -->')) throw new Error(`${documentPath}: no <!-- tables --> marks`);
writeFileSync(documentPath, after);
