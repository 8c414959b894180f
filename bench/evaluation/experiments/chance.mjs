// SPDX-License-Identifier: MIT
// False positives: models without a mark, with another key's, with another scheme's, read with keys that never marked
// anything. Claims are counted in chance.csv, not one by one.
import { join } from 'node:path';
import { tableOf } from '../../support/table.mjs';
import { atMost, ChanceRows, mergeBins, trialsOf } from '../chance_rows.mjs';
import { absence, isPresent, modelPath } from '../models.mjs';
import { askWorker } from '../worker.mjs';

export const name = 'chance';
export const title = 'False positives';

const KINDS = { unmarked: 'unmarked', 'wrong-key': 'marked, wrong key', 'other-mark': "another scheme's mark" };
const MODELS = ['sculpture:3000:1', 'part:2500:1', 'Duck.glb'];
const SLOW = ['robust', 'cayre-spectral']; // 0.1 s a reading and more
const blockOf = ({ scheme }) => (SLOW.includes(scheme) ? 100 : 600); // trials of one process, which marks first
const EXPONENTS = [-1, -2, -3, -4];

const models = ({ quick }) => (quick ? MODELS.slice(0, 1) : MODELS);

function wanted({ quick }, scheme) {
  if (quick) return SLOW.includes(scheme) ? 20 : 70;
  return Math.ceil((SLOW.includes(scheme) ? 3400 : 10_000) / MODELS.length); // of each kind and model
}

const rowsOf = ({ folder }) => new ChanceRows(join(folder, 'chance.csv'));

function cellsOf(context) {
  return context.schemes.flatMap(({ name: scheme, usualSettings: settings }) =>
    Object.keys(KINDS).flatMap((kind) =>
      models(context)
        .filter(isPresent)
        .map((model) => ({ scheme, settings, kind, model })),
    ),
  );
}

/** Whose marks block `first` of a cell reads: all other schemes in turn, those that refused the model left out. */
function markOf(cell, first, schemes, refused) {
  const { scheme, kind, model } = cell;
  if (kind === 'unmarked') return '';
  if (kind === 'wrong-key') return scheme;
  const others = schemes
    .map((other) => other.name)
    .filter((other) => other !== scheme && !refused.has(`${other} ${model}`));
  return others[Math.floor(first / blockOf(cell)) % others.length];
}

/** Block after block of each cell, those with the fewest first, so that a run that is stopped has some of everything. */
export async function run(context) {
  const rows = rowsOf(context),
    errors = [],
    refused = new Set(),
    dead = new Set();
  const share = (cell) => rows.trials(cell) / wanted(context, cell.scheme);
  const open = () =>
    cellsOf(context)
      .filter((cell) => !dead.has(JSON.stringify(cell)) && share(cell) < 1)
      .sort((a, b) => share(a) - share(b));
  const ended = (cell) => context.progress.ended(`chance: ${cell.scheme}, ${cell.kind}, ${cell.model}`);

  const block = async (cell) => {
    const first = rows.trials(cell);
    const count = Math.min(blockOf(cell) - (first % blockOf(cell)), wanted(context, cell.scheme) - first);
    const mark = markOf(cell, first, context.schemes, refused);
    if (mark === undefined) return rows.refuse(cell, 'no other scheme marks this model');
    const answer = await askWorker(
      'chance',
      cell.scheme,
      cell.settings,
      mark,
      modelPath(cell.model),
      String(first),
      String(count),
    );
    if (answer.bins) return rows.add(cell, answer.bins);
    refused.add(`${mark} ${cell.model}`);
    return cell.kind === 'other-mark' ? block(cell) : rows.refuse(cell, answer.note);
  };

  for (let cells = open(); cells.length > 0 && !context.signal.aborted; cells = open()) {
    context.progress.expect(cells.length);
    let next = 0;
    const serve = async () => {
      while (next < cells.length && !context.signal.aborted) {
        const cell = cells[next++],
          before = rows.trials(cell);
        try {
          await block(cell);
        } catch (error) {
          errors.push(`chance, ${cell.scheme}, ${cell.kind}, ${cell.model}: ${error.message}`);
        }
        if (rows.trials(cell) === before) dead.add(JSON.stringify(cell));
        rows.save();
        ended(cell);
      }
    };
    await Promise.all(Array.from({ length: context.parallel }, serve));
  }
  return errors;
}

function show(count, trials) {
  if (trials === 0) return '-';
  return count === 0 ? '0' : (count / trials).toPrecision(2).replace(/^0\./, '.');
}

/** A kind of trial of a scheme, all models together: null where nothing was tried. */
function summary(cells) {
  const bins = mergeBins(cells),
    trials = trialsOf(bins);
  if (trials === 0) return null;
  return { trials, bins, matches: bins.reduce((sum, bin) => sum + bin.matches, 0), least: 10 ** bins[0].claim };
}

/** [{ scheme, kind, trials, bins, matches, least, notes }]: what the table and the plot show. */
export function summaries(context) {
  const cells = rowsOf(context).cells();
  return context.schemes.flatMap(({ name: scheme, usualSettings: settings }) =>
    Object.entries(KINDS).map(([kind, words]) => {
      const mine = cells.filter((cell) => cell.scheme === scheme && cell.settings === settings && cell.kind === kind);
      return {
        scheme,
        kind,
        words,
        ...summary(mine),
        notes: mine.filter((cell) => cell.note).map((cell) => `${cell.model}: ${cell.note}`),
      };
    }),
  );
}

export function document(context) {
  const all = summaries(context),
    measured = new Set(
      rowsOf(context)
        .cells()
        .map(({ model }) => model),
    );
  const rows = all.map(({ scheme, words, trials, bins, matches, least, notes }) =>
    trials === undefined
      ? [
          scheme,
          words,
          `not measured${notes.length > 0 ? `: ${notes.join('; ')}` : ''}`,
          ...EXPONENTS.map(() => '-'),
          '-',
          '-',
        ]
      : [
          scheme,
          words,
          trials,
          ...EXPONENTS.map((exponent) => show(atMost(bins, exponent), trials)),
          least.toExponential(0),
          matches,
        ],
  );
  const sum = all.reduce((total, one) => total + (one.trials ?? 0), 0),
    matches = all.reduce((total, one) => total + (one.matches ?? 0), 0);
  const exceeded = all.filter((one) => one.trials && one.least * one.trials < 0.01);
  return `Readings with keys that marked nothing (64-bit IDs): of ${models(context).join(', ')} without a mark, with the mark of another
key of the same scheme, and with the marks of all other schemes in turn. Columns: share of the trials whose claimed
probability was at most the number in the head; what is above it would be a false claim. Claims come in steps, so shares below are
usual. "Least": the smallest claim met, rounded up to a tenth of a decade.

${tableOf(['scheme', 'model', 'trials', ...EXPONENTS.map((exponent) => `<= 1e${exponent}`), 'least', 'taken for a mark'], rows)}

${sum} trials, ${matches} taken for a mark. Claims of \`robust\` and \`paper\` have paid for all hypotheses and parts that one reading
tries; those of the peers are binomial tails of one reading. Over this run the same rule holds once more: a claim, times the number of
trials of its row, ${exceeded.length === 0 ? 'is nowhere below .01' : `is below .01 for ${exceeded.map((one) => `${one.scheme} (${one.words}: ${(one.least * one.trials).toExponential(0)})`).join(', ')}`}.
${models(context)
  .filter((model) => !measured.has(model))
  .map(absence)
  .join('\n')}`;
}
