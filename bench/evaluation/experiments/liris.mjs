// SPDX-License-Identifier: MIT
import { tableOf as markdownTable } from '../../support/table.mjs';
import { errorCell, measuredTable, recoveredCell } from '../cells.mjs';
import { absence, QUICK_MODELS, wasMeasured } from '../models.mjs';

export const name = 'liris';
export const title = 'The LIRIS protocol, with peers';

const payload = 'id';
const MODELS = ['bunny.ply', 'rocker-arm.ply', 'fandisk.ply', 'sculpture:20000:2'];
export const models = ({ quick }) => (quick ? QUICK_MODELS.slice(0, 1) : MODELS);

// The larger of both directions' RMS distance between the surfaces, of the diagonal.
export const LIMITS = { geometric: 0.0002, perceptual: 0.0008 };

const percent = (share) => `${+(100 * share).toFixed(2)} %`;
const LIRIS = [
  { label: 'none', attack: 'none', quick: true },
  ...[0.0005, 0.001, 0.003, 0.005].map((a) => ({ label: `noise ${percent(a)}`, attack: `liris-noise:${a}`, quick: a > 0.0005 && a < 0.005 })),
  ...[5, 10, 30, 50].map((steps) => ({ label: `smoothing, ${steps} steps`, attack: `smooth:0.03:laplacian:${steps}`, quick: steps === 10 })),
  ...[11, 10, 9, 8, 7].flatMap((bits) => [
    { label: `${bits} bits, a grid per axis`, attack: `quantize:${bits}:per-axis`, quick: bits === 9 },
    { label: `${bits} bits, one grid (Draco)`, attack: `quantize:${bits}`, quick: bits === 9 },
  ]),
  ...[0.1, 0.3, 0.5, 0.7, 0.9, 0.95].map((removed) => ({ label: `${percent(removed)} of the vertices simplified away`, attack: `simplify:${removed}:qem`, quick: removed === 0.1 })),
  ...[0.1, 0.3, 0.5].map((share) => ({ label: `crop ${percent(share)}`, attack: `crop:${share}`, quick: share === 0.1 })),
  { label: 'subdivision (midpoints)', attack: 'subdivide:1' },
  { label: 'similarity', attack: 'affine::R+affine::S', quick: true },
  { label: 'vertex order', attack: 'reorder', quick: true },
  { label: 'affine map (not of the protocol)', attack: 'affine::CB', quick: true },
];
export const attacks = ({ quick }) => (quick ? LIRIS.filter((one) => one.quick) : LIRIS);

/** Settings of a scheme: the one that comes closest to a limit without passing it is taken. */
function ladder({ name: scheme, usualSettings, peer }, quick) {
  if (scheme === 'robust') return ['strong', 'standard', 'invisible'];
  if (scheme === 'paper') return ['L=2', 'L=3', 'L=4'];
  const [, low, high] = /\bstrength ([\d.e-]+) \.\. ([\d.e-]+)/.exec(peer.settings) ?? [];
  const [, usual] = /\bstrength=([\d.e-]+)/.exec(usualSettings) ?? [];
  if (!usual || !low) return [usualSettings];
  const factors = quick ? [4, 1, 0.25] : [32, 20, 12, 8, 5.6, 4, 3, 2.2, 1.6, 1.25, 1, 0.75, 0.5, 0.35, 0.25, 0.15, 0.08];
  return factors.map((factor) => Number((usual * factor).toPrecision(2))).filter((strength) => strength >= low && strength <= high)
    .map((strength) => `strength=${strength}`);
}

/** The settings that a scheme takes for a model and limit, by its first marks; null: none keeps within it. Undefined before. */
function settingsFor(context, scheme, model, limit) {
  const all = ladder(scheme, context.quick);
  const marks = context.rows.select({ scheme: scheme.name, settings: all, payload, model, seed: 1, attack: 'mark' });
  if (marks.length < all.length) return undefined;
  const within = marks.filter(({ outcome, rms }) => outcome === 'written' && rms <= LIMITS[limit]);
  return within.length === 0 ? null : within.reduce((a, b) => (b.rms > a.rms ? b : a)).settings;
}

const refused = (context, scheme, model) =>
  context.rows.select({ scheme: scheme.name, payload, model, seed: 1, attack: 'mark', settings: ladder(scheme, context.quick) }).every(({ outcome }) => outcome === 'refused');

export const jobs = (context) => models(context).flatMap((model) => context.schemes.flatMap((scheme) => {
  const first = ladder(scheme, context.quick).map((settings) => ({ scheme: scheme.name, settings, payload, model, seed: 1, attacks: [] }));
  const chosen = new Set(Object.keys(LIMITS).map((limit) => settingsFor(context, scheme, model, limit)).filter((settings) => settings != null));
  return [...first, ...[...chosen].flatMap((settings) => context.seeds.map((seed) =>
    ({ scheme: scheme.name, settings, payload, model, seed, attacks: attacks(context).map(({ attack }) => attack) })))];
}));

/** The readings of a scheme within a limit after an attack. */
export const readings = (context, scheme, model, limit, attack) => {
  const settings = settingsFor(context, scheme, model, limit);
  return settings != null ? context.rows.select({ scheme: scheme.name, settings, payload, model, attack }) : [];
};

function cellOf(context, scheme, list, limit, attack, cell) {
  const rows = list.flatMap((model) => readings(context, scheme, model, limit, attack));
  if (rows.length > 0) return cell(rows);
  const said = (model) => (settingsFor(context, scheme, model, limit) === undefined ? 'not measured' : refused(context, scheme, model) ? 'refused' : 'above the limit');
  return [...new Set(list.map(said))].join(', ');
}

function tableOf(context, list, limit, cell) {
  return measuredTable(['attack', ...context.schemes.map((scheme) => scheme.name)], attacks(context).map(({ label, attack }) =>
    [label, ...context.schemes.map((scheme) => cellOf(context, scheme, list, limit, attack, cell))]));
}

function settingsTable(context, list, limit) {
  return markdownTable(['scheme', ...list], context.schemes.map((scheme) => [scheme.name, ...list.map((model) => {
    const settings = settingsFor(context, scheme, model, limit);
    if (settings == null) return settings === undefined ? 'not measured' : refused(context, scheme, model) ? 'refused' : 'above the limit';
    const [{ rms, msdm2 }] = context.rows.select({ scheme: scheme.name, settings, payload, model, seed: 1, attack: 'mark' });
    return `${settings === '' ? '' : `${settings}: `}${(100 * rms).toFixed(4)} %, ${msdm2?.toFixed(2) ?? '-'}`;
  })]));
}

const average = (rows) => rows.reduce((sum, row) => sum + row.ber, 0) / rows.length;
const isOurs = ({ name: scheme }) => scheme === 'robust';

/** Whether bits agree more than coin flips do, at the level of 1 %. */
const tellsSomething = (rows) => average(rows) < 0.5 - 1.163 / Math.sqrt(64 * rows.length);

/** Attacks after which a peer's bits are better than ours, and better than chance. */
export const losses = (context) => Object.keys(LIMITS).flatMap((limit) => models(context).filter((model) => wasMeasured(context, model)).flatMap((model) =>
  attacks(context).flatMap(({ label, attack }) => {
    const measured = context.schemes.map((scheme) => ({ scheme, rows: readings(context, scheme, model, limit, attack).filter(({ ber }) => ber !== undefined) }));
    const ours = measured.find(({ scheme }) => isOurs(scheme));
    const others = measured.filter(({ scheme, rows }) => !isOurs(scheme) && rows.length > 0 && tellsSomething(rows));
    if (others.length === 0) return [];
    const best = others.reduce((a, b) => (average(b.rows) < average(a.rows) ? b : a));
    if (ours.rows.length > 0 && average(ours.rows) <= average(best.rows)) return [];
    const say = ({ scheme, rows }) => (rows.length > 0 ? `\`${scheme.name}\` ${(100 * average(rows)).toFixed(1)} % (${rows.length})` : `\`${scheme.name}\` nothing within the limit`);
    return [{ where: `LIRIS, ${limit}: ${model}, ${label}`, ours: say(ours), theirs: say(best) }];
  })));

export function document(context) {
  const there = models(context).filter((model) => wasMeasured(context, model)), absent = models(context).filter((model) => !wasMeasured(context, model));
  const section = (limit) => `### The ${limit} limit: surface RMS <= ${percent(LIMITS[limit])} of the diagonal

Settings, RMS and MSDM2 of the first seed:

${settingsTable(context, there, limit)}

Bit error rates in percent, means over ${there.length === 1 ? there[0] : `the ${there.length} models`}:

${tableOf(context, there, limit, errorCell)}

Trials that came back whole, and ("+") those that were recognised only:

${tableOf(context, there, limit, recoveredCell)}

${there.length < 2 ? '' : `<details><summary>Bit error rates model by model</summary>\n\n${there.map((model) => `${model}:\n\n${tableOf(context, [model], limit, errorCell)}`).join('\n\n')}\n\n</details>\n`}`;
  return `Wang, Lavoue, Denis, Baskurt, He (SMI 2010): 64 bits, a key of its own for each trial. Noise is uniform in [-a, a] per coordinate, a relative to the mean
distance of the vertices to their centre; smoothing is Laplacian with lambda .03; quantization has a grid per axis there, and one
for all in Draco. Each scheme takes, model by model, those of its settings that come closest to the limit without passing it. The protocol's
perceptual limit also asks for MSDM <= .20; MSDM2 is another scale, so it is shown and not asked for, in the peers' favour. Of the
protocol's models only the Bunny is to be had; simplification is by quadrics, subdivision at midpoints. An ID of \`robust\` comes back
whole or not at all, so that its error rate is 0 or 50 % per trial.

${Object.keys(LIMITS).map(section).join('\n')}
${absent.map((model) => absence(model)).join(' ')}`;
}
