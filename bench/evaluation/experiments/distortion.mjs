// SPDX-License-Identifier: MIT
import { meanCell, measuredTable } from '../cells.mjs';
import { absence, QUICK_MODELS, wasMeasured } from '../models.mjs';

export const name = 'distortion';
export const title = 'Distortion of every scheme';

const MODELS = ['bunny.ply', 'rocker-arm.ply', 'nefertiti.ply', 'ogre.ply', 'fandisk.ply', 'Duck.glb', 'sculpture:20000:2', 'part:12000:2'];
const MEASURES = {
  'Hausdorff, 1e-3': ['hausdorff', (x) => (1000 * x).toFixed(2)], 'surface RMS, %': ['rms', (x) => (100 * x).toFixed(4)],
  'largest move, %': ['max', (x) => (100 * x).toFixed(2)], 'SNR dB': ['snr', (x) => x.toFixed(1)], 'PSNR dB': ['psnr', (x) => x.toFixed(1)],
  'normals, deg': ['normals', (x) => x.toFixed(2)], MSDM2: ['msdm2', (x) => x.toFixed(3)],
};
// Moves coordinates by a unit in the last place: before everybody else by every measure, and gone after every attack.
const FINEST = 'lsb-hmac';
const MORE_IS_BETTER = ['snr', 'psnr'];
export const models = ({ quick }) => (quick ? QUICK_MODELS.slice(0, 1) : MODELS);
export const marks = (context) => context.schemes.flatMap(({ name: scheme, usualSettings }) =>
  [...(scheme === 'robust' ? ['invisible', usualSettings, 'strong'] : [usualSettings])].map((settings) => ({ scheme, settings, payload: 'id' })));

export const jobs = (context) => marks(context).flatMap((mark) => models(context).flatMap((model) => context.seeds.map((seed) => ({ ...mark, model, seed, attacks: [] }))));

/** Measures by which a peer at its usual settings disturbs a model less than `robust` at its own. */
export const losses = (context) => models(context).flatMap((model) => Object.entries(MEASURES).flatMap(([label, [column, show]]) => {
  const means = context.schemes.flatMap(({ name: scheme, usualSettings: settings }) => {
    const values = context.rows.select({ scheme, settings, payload: 'id', model, attack: 'mark' }).map((row) => row[column]).filter((x) => x !== undefined);
    return values.length > 0 ? [{ scheme, count: values.length, mean: values.reduce((sum, x) => sum + x, 0) / values.length }] : [];
  });
  const sign = MORE_IS_BETTER.includes(column) ? 1 : -1;
  const ours = means.find(({ scheme }) => scheme === 'robust'), others = means.filter(({ scheme }) => !['robust', 'paper', FINEST].includes(scheme));
  if (!ours || others.length === 0) return [];
  const best = others.reduce((a, b) => (sign * (b.mean - a.mean) > 0 ? b : a));
  if (sign * (ours.mean - best.mean) >= 0) return [];
  const say = ({ scheme, mean, count }) => `\`${scheme}\` ${show(mean)} (${count})`;
  return [{ where: `Distortion, ${model}: ${label}`, ours: say(ours), theirs: say(best) }];
}));

export function document(context) {
  const tables = models(context).map((model) => (wasMeasured(context, model)
    ? `${model}:\n\n${measuredTable(['scheme', 'settings', ...Object.keys(MEASURES)], marks(context).map((mark) => {
      const rows = context.rows.select({ ...mark, model, attack: 'mark' });
      return [mark.scheme, mark.settings, ...Object.values(MEASURES).map(([column, show]) => meanCell(rows, column, show))];
    }))}`
    : absence(model)));
  return `64-bit IDs at each scheme's usual settings. Lengths are fractions of the diagonal; what each measure is stands in
[bench/README.md](../bench/README.md). At equal distortion the schemes are compared in the LIRIS section.
\`lsb-hmac\` moves coordinates by a unit in the last place, which no other scheme comes near to, and which hardly any attack
leaves there: the conclusion does not repeat it line by line.

${tables.join('\n\n')}`;
}
