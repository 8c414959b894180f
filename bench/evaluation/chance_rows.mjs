// SPDX-License-Identifier: MIT
// The rows of chance.csv (bench/README.md): how many trials without the reader's mark claimed what.
import { existsSync, readFileSync } from 'node:fs';
import { parse } from 'csv-parse/sync';
import { replaceFile, textField } from './csv.mjs';

const COLUMNS = ['scheme', 'settings', 'kind', 'model', 'claim', 'trials', 'matches', 'note'];
const cellOf = ({ scheme, settings, kind, model }) => JSON.stringify([scheme, settings, kind, model]);
const order = new Intl.Collator('en', { numeric: true });

export class ChanceRows {
  #path;
  #cells = new Map(); // name -> { scheme, settings, kind, model, bins: Map(tenths -> { trials, matches }), note }

  constructor(path) {
    this.#path = path;
    if (!existsSync(path)) return;
    for (const { claim, trials, matches, note, ...cell } of parse(readFileSync(path), { columns: true })) {
      if (note !== '') this.refuse(cell, note);
      else this.#add(cell, Math.round(-10 * Number(claim)), Number(trials), Number(matches));
    }
  }

  #cell(cell) {
    const name = cellOf(cell);
    if (!this.#cells.has(name)) this.#cells.set(name, { ...cell, bins: new Map(), note: '' });
    return this.#cells.get(name);
  }

  #add(cell, tenths, trials, matches) {
    const { bins } = this.#cell(cell),
      bin = bins.get(tenths) ?? { trials: 0, matches: 0 };
    bins.set(tenths, { trials: bin.trials + trials, matches: bin.matches + matches });
  }

  /** How many trials a cell { scheme, settings, kind, model } has. */
  trials(cell) {
    return [...this.#cell(cell).bins.values()].reduce((sum, bin) => sum + bin.trials, 0);
  }

  /** Adds what the worker counted: { tenths: { trials, matches } }. */
  add(cell, bins) {
    for (const [tenths, { trials, matches }] of Object.entries(bins)) this.#add(cell, Number(tenths), trials, matches);
  }

  /** A cell that has no trials, and why. */
  refuse(cell, note) {
    this.#cell(cell).note = note;
  }

  /** All cells, ordered by name; `bins` by rising claim. */
  cells() {
    return [...this.#cells.values()]
      .map((cell) => ({
        ...cell,
        bins: [...cell.bins]
          .map(([tenths, bin]) => ({ claim: -tenths / 10, ...bin }))
          .sort((a, b) => a.claim - b.claim),
      }))
      .sort((a, b) => order.compare(cellOf(a), cellOf(b)));
  }

  /** Writes the file anew. A run that is killed meanwhile leaves the old one. */
  save() {
    const lines = this.cells().flatMap(({ bins, note, scheme, settings, kind, model }) =>
      (note
        ? [['', 0, 0, note]]
        : bins.map(({ claim, trials, matches }) => [claim.toFixed(1), trials, matches, ''])
      ).map((rest) => [scheme, settings, kind, model, ...rest].map((field) => textField(String(field))).join(',')),
    );
    replaceFile(this.#path, `${[COLUMNS.join(','), ...lines].join('\n')}\n`);
  }
}

/** Cells as one: the sum of their bins. */
export function mergeBins(cells) {
  const sums = new Map();
  for (const { bins } of cells) {
    for (const { claim, trials, matches } of bins) {
      const sum = sums.get(claim) ?? { claim, trials: 0, matches: 0 };
      sums.set(claim, { claim, trials: sum.trials + trials, matches: sum.matches + matches });
    }
  }
  return [...sums.values()].sort((a, b) => a.claim - b.claim);
}

/** How many trials of these bins claimed at most 10^exponent; the exponent has one decimal. */
export const atMost = (bins, exponent) =>
  bins.reduce((sum, bin) => sum + (bin.claim <= exponent + 1e-9 ? bin.trials : 0), 0);

export const trialsOf = (bins) => atMost(bins, 0);
