// SPDX-License-Identifier: MIT
// What the paper prints (Gao, Zhang, Huang, Deng 2012), and tables of our readings beside it.
import { errorCell, measuredTable } from './cells.mjs';
import { absence, QUICK_MODELS, wasMeasured } from './models.mjs';

/** The models of the paper that are to be had, with its digits; others that it has not. */
export const PRINTED = [{ model: 'fandisk.ply', settings: 'L=3', printed: 'Fandisk' }, { model: 'bunny.ply', settings: 'L=2', printed: 'Bunny' }];
export const OTHERS = [
  ...['rocker-arm.ply', 'nefertiti.ply', 'ogre.ply', 'beast-quads.ply', 'igea-tristrips.ply', 'Duck.glb', 'SheenCloth.glb', 'clothFolds.glb', 'sculpture:20000:2']
    .map((model) => ({ model, settings: 'L=2' })),
  { model: 'part:12000:2', settings: 'L=3' },
];
/** Models without a figure of the paper that its tables are repeated on. */
export const BESIDE = OTHERS.filter(({ model }) => /^(rocker|nefertiti|ogre|sculpture|part)/.test(model));
const QUICK = QUICK_MODELS.map((model) => ({ model, settings: model.startsWith('part') ? 'L=3' : 'L=2' }));

/** The cases of a context: { model, settings, printed? }. */
export const casesOf = ({ quick }, cases) => (quick ? QUICK : cases);

/** Jobs of scheme `paper` with the digits of each case, and of `robust` where asked. */
export function paperJobs(context, cases, payload, attacks, { robust = true } = {}) {
  return casesOf(context, cases).flatMap(({ model, settings }) => context.seeds.flatMap((seed) => [
    { scheme: 'paper', settings, payload, model, seed, attacks },
    ...(robust ? [{ scheme: 'robust', payload, model, seed, attacks }] : []),
  ]));
}

const shown = (share) => (share === undefined ? '' : `${(100 * share).toFixed(1)}`);

/** A line for each case whose model is not there. */
export const absences = (context, cases) => casesOf(context, cases).filter(({ model }) => !wasMeasured(context, model)).map(({ model }) => absence(model)).join(' ');

/**
 * Bit error rates in percent of one scheme on all cases: a row per attack, beside each model the paper's own figure, and
 * the figures of its models that are not to be had.
 *
 * @param attacks  [{ label, attack, printed?: { Bunny: share, ... } }]
 */
export function errorTable(context, { scheme, payload, cases, attacks, printed = scheme === 'paper' }) {
  const there = casesOf(context, cases).filter(({ model }) => wasMeasured(context, model));
  const models = printed && !context.quick ? [...new Set(attacks.flatMap((one) => Object.keys(one.printed ?? {})))] : [];
  const elsewhere = models.filter((name) => !there.some((one) => one.printed === name));
  const settingsOf = (settings) => (scheme === 'paper' ? settings : undefined);
  const head = ['attack', ...there.flatMap((one) => (models.includes(one.printed) ? [one.model, `the paper's ${one.printed}`] : [one.model])),
    ...elsewhere.map((name) => `the paper's ${name}`)];
  return measuredTable(head, attacks.map(({ label, attack, printed: figures = {} }) => [label,
    ...there.flatMap((one) => {
      const cell = errorCell(context.rows.select({ scheme, settings: settingsOf(one.settings), payload, model: one.model, attack }));
      return models.includes(one.printed) ? [cell, shown(figures[one.printed])] : [cell];
    }),
    ...elsewhere.map((name) => shown(figures[name]))]));
}

/** Where our mean bit error rate is above the paper's on a model of it: for the conclusion. */
export function lossesToPaper(context, { title, payload, cases, attacks }) {
  if (context.quick) return [];
  return casesOf(context, cases).filter((one) => one.printed).flatMap((one) => attacks.flatMap(({ label, attack, printed = {} }) => {
    const rows = context.rows.select({ scheme: 'paper', settings: one.settings, payload, model: one.model, attack, ber: (ber) => ber !== undefined });
    if (rows.length === 0 || printed[one.printed] === undefined) return [];
    const ours = rows.reduce((sum, row) => sum + row.ber, 0) / rows.length;
    if (ours <= printed[one.printed]) return [];
    return [{ where: `${title}: ${one.printed}, ${label}`, ours: `\`paper\` ${shown(ours)} % (${rows.length})`, theirs: `the paper ${shown(printed[one.printed])} %` }];
  }));
}
