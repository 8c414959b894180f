// SPDX-License-Identifier: MIT
import { meanCell, measuredTable } from '../cells.mjs';
import { absence, QUICK_MODELS, wasMeasured } from '../models.mjs';

export const name = 'table1';
export const title = 'Capacity and distortion (the paper, Table I)';

const PAPER = {  // capacity in bits, Hausdorff distance / 1e-3, SNR and PSNR in dB
  'fandisk.ply': ['Fandisk', 13788, 0.421, 61.24, 67.6],
  'bunny.ply': ['Bunny', 51408, 0.548, 51.39, 70.02],
};
const OTHERS = { Dragon: [31797, 0.922, 51.59, 64.67], Buddha: [48465, 0.737, 54.5, 66.43] };
const cases = ({ quick }) => (quick
  ? QUICK_MODELS.map((model) => ({ model, settings: 'L=3', payload: 'image:24' }))
  : [{ model: 'fandisk.ply', settings: 'L=3', payload: 'image:90' }, { model: 'bunny.ply', settings: 'L=2', payload: 'image:90' },
    ...['rocker-arm.ply', 'nefertiti.ply', 'ogre.ply', 'beast-quads.ply', 'igea-tristrips.ply'].map((model) => ({ model, settings: 'L=2', payload: 'image:24' }))]);

export const jobs = (context) => cases(context).flatMap((one) => context.seeds.map((seed) => ({ scheme: 'paper', ...one, seed, attacks: [] })));

const MEASURES = [  // column, what the paper prints of it, whether more is better, as text
  ['capacity', 'capacity', true, (x) => `${x.toFixed(0)} bits`], ['hausdorff', 'Hausdorff distance', false, (x) => `${(1000 * x).toFixed(3)}e-3`],
  ['snr', 'SNR', true, (x) => `${x.toFixed(1)} dB`],
];

export const losses = (context) => cases(context).filter(({ model }) => PAPER[model]).flatMap((one) => {
  const [printed, capacity, hausdorff, snr] = PAPER[one.model];
  return MEASURES.flatMap(([column, words, more, show]) => {
    const values = context.rows.select({ scheme: 'paper', ...one, attack: 'mark' }).map((row) => row[column]).filter((x) => x !== undefined);
    const ours = values.reduce((sum, x) => sum + x, 0) / values.length, theirs = { capacity, hausdorff: hausdorff / 1000, snr }[column];
    if (values.length === 0 || (more ? ours >= theirs : ours <= theirs)) return [];
    return [{ where: `Table I: ${printed}, ${words}`, ours: `\`paper\` ${show(ours)} (${values.length})`, theirs: `the paper ${show(theirs)}` }];
  });
});

export function document(context) {
  const rows = cases(context).filter(({ model }) => wasMeasured(context, model)).map((one) => {
    const marks = context.rows.select({ scheme: 'paper', ...one, attack: 'mark' });
    return [one.model, one.payload, one.settings, meanCell(marks, 'capacity', (x) => x.toFixed(0)),
      meanCell(marks, 'hausdorff', (x) => (1000 * x).toFixed(3)), meanCell(marks, 'snr', (x) => x.toFixed(1)),
      meanCell(marks, 'psnr', (x) => x.toFixed(1)), meanCell(marks, 'normals', (x) => x.toFixed(2)), (PAPER[one.model] ?? []).slice(1).join(' / ') || '-'];
  });
  const absent = cases(context).filter(({ model }) => !wasMeasured(context, model)).map(({ model }) => absence(model));
  return `Scheme \`paper\`; H by Eq. (7). The last column is the paper's own: capacity / Hausdorff / SNR / PSNR.

${measuredTable(['model', 'payload', 'digits', 'capacity, bits', 'Hausdorff, 1e-3', 'SNR dB', 'PSNR dB', 'normals deg', 'the paper'], rows)}

The paper's other models are not to be had: ${Object.entries(OTHERS).map(([model, figures]) => `${model} (${figures.join(' / ')})`).join(', ')}.
Its Bunny is one it does not specify, with fewer cells than Stanford's, so equality is not to be expected there. Its PSNR
values fit no common definition: ours is 20 log10(pi / rms angle between vertex normals), and not to be compared.
${absent.join('\n')}`;
}
