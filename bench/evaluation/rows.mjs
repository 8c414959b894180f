// SPDX-License-Identifier: MIT
// The rows of readings.csv (bench/README.md): read once, appended to while measuring, sorted at the end.
import { appendFileSync, existsSync, readFileSync, truncateSync } from 'node:fs';
import { parse } from 'csv-parse/sync';
import { replaceFile, textField } from './csv.mjs';

const NAME = ['scheme', 'settings', 'payload', 'model', 'seed', 'attack'];
const NUMBERS = ['ber', 'unread', 'claim', 'vertices', 'capacity', 'carriers', 'hausdorff', 'rms', 'max', 'snr', 'psnr', 'normals', 'msdm2'];
export const COLUMNS = [...NAME, 'outcome', ...NUMBERS, 'note'];
const HEAD = `${COLUMNS.join(',')}\n`;

const nameOf = (row) => NAME.map((column) => row[column]).join('\n');

const placeOf = ({ scheme, model }) => `${scheme}\n${model}`;

function fieldOf(value) {
  if (value === undefined || value === null) return '';
  if (typeof value === 'number') return String(Number(value.toPrecision(5)));
  return textField(String(value));
}

const lineOf = (row) => `${COLUMNS.map((column) => fieldOf(row[column])).join(',')}\n`;

function rowFrom(record, path) {
  const row = {};
  for (const column of COLUMNS) {
    if (!(column in record)) throw new Error(`${path}: no column ${column}`);
    if (record[column] === '') continue;
    row[column] = column === 'seed' || NUMBERS.includes(column) ? Number(record[column]) : record[column];
  }
  row.settings ??= '';
  return row;
}

/** By scheme, settings, payload, model, attack, seed: what a table puts into one cell stands together. */
const compare = new Intl.Collator('en', { numeric: true }).compare;
const ORDER = ['scheme', 'settings', 'payload', 'model', 'attack', 'seed'];
function byName(a, b) {
  for (const column of ORDER) {
    const order = compare(String(a[column]), String(b[column])) || (String(a[column]) < String(b[column]) ? -1 : Number(String(a[column]) > String(b[column])));
    if (order !== 0) return order;
  }
  return 0;
}

export class Rows {
  #path;
  #rows = [];
  #names = new Set();
  #places = new Map();  // scheme and model -> rows: what nearly every cell asks for
  /** Rows that were added since the file was opened. */
  added = 0;

  /** Opens a file, or begins one. What a killed process left of a last line is cut off. */
  constructor(path) {
    this.#path = path;
    if (!existsSync(path)) return;
    const bytes = readFileSync(path);
    const end = bytes.lastIndexOf('\n') + 1;
    if (end < bytes.length) truncateSync(path, end);
    for (const record of parse(bytes.subarray(0, end), { columns: true })) this.#keep(rowFrom(record, path));
  }

  #keep(row) {
    const name = nameOf(row);
    if (this.#names.has(name)) throw new Error(`${this.#path}: two rows ${name.replaceAll('\n', ', ')}`);
    this.#names.add(name);
    this.#rows.push(row);
    const place = placeOf(row);
    if (!this.#places.has(place)) this.#places.set(place, []);
    this.#places.get(place).push(row);
  }

  /** Whether there is a row with this name: its first six columns. */
  has(row) {
    return this.#names.has(nameOf(row));
  }

  /** Keeps a row, in the file at once. Numbers are kept as precisely as the file has them. */
  add(row) {
    for (const column of Object.keys(row)) if (!COLUMNS.includes(column)) throw new Error(`a row has no column ${column}`);
    const line = lineOf(row);
    const [record] = parse(line, { columns: COLUMNS });
    this.#keep(rowFrom(record, this.#path));
    if (!existsSync(this.#path)) replaceFile(this.#path, HEAD);
    appendFileSync(this.#path, line);
    ++this.added;
  }

  /** The rows whose columns have these values; a value may be a list of them, or a function of one. */
  select(filter = {}) {
    const tests = Object.entries(filter).filter(([, wanted]) => wanted !== undefined);
    const fits = (value, wanted) =>
      (typeof wanted === 'function' ? wanted(value) : Array.isArray(wanted) ? wanted.includes(value) : value === wanted);
    const near = typeof filter.scheme === 'string' && typeof filter.model === 'string' ? this.#places.get(placeOf(filter)) ?? [] : this.#rows;
    return near.filter((row) => tests.every(([column, wanted]) => fits(row[column], wanted)));
  }

  /** Drops the rows of which test(row) is true, so that they are measured again. */
  forget(test) {
    const kept = this.#rows.filter((row) => !test(row));
    if (kept.length === this.#rows.length) return;
    this.#rows = [];
    this.#names.clear();
    this.#places.clear();
    for (const row of kept) this.#keep(row);
    this.#write();
  }

  /** Orders the file by name. */
  sort() {
    if (!existsSync(this.#path)) return;
    this.#rows.sort(byName);
    this.#write();
  }

  #write() {
    replaceFile(this.#path, HEAD + this.#rows.map(lineOf).join(''));
  }
}
