// SPDX-License-Identifier: MIT
import { meanCell, measuredTable } from '../cells.mjs';
import { wasMeasured } from '../models.mjs';
import { absences, casesOf, PRINTED } from '../paper.mjs';

export const name = 'fig9';
export const title = 'Digits against distortion (the paper, Fig. 9)';

export const payload = 'image:24';
export const BY_H = [3, 4, 5, 6, 7].map((H) => `L=2 H=${H}`);
export const BY_L = [2, 3, 4, 5].map((L) => `L=${L} H=${L + 2}`);
const SETTINGS = [...new Set([...BY_H, ...BY_L])];
export const models = (context) => casesOf(context, PRINTED).map(({ model }) => model);

export const jobs = (context) => models(context).flatMap((model) => context.seeds.flatMap((seed) =>
  SETTINGS.map((settings) => ({ scheme: 'paper', settings, payload, model, seed, attacks: [] }))));

export function document(context) {
  const there = models(context).filter((model) => wasMeasured(context, model));
  const table = (list) => measuredTable(['digits', ...there.flatMap((model) => [`${model}: Hausdorff, 1e-3`, 'capacity, bits', 'SNR dB'])],
    list.map((settings) => [settings, ...there.flatMap((model) => {
      const marks = context.rows.select({ scheme: 'paper', settings, payload, model, attack: 'mark' });
      return [meanCell(marks, 'hausdorff', (x) => (1000 * x).toFixed(3)), meanCell(marks, 'capacity', (x) => x.toFixed(0)), meanCell(marks, 'snr', (x) => x.toFixed(1))];
    })]));
  return `Scheme \`paper\`, 24 x 24 pixels. The paper says of its curves, which it gives without figures: with L = 2 the distance grows
with H and hardly so beyond 5; with H = L + 2 it falls with L and is almost constant from 4 on.

With L = 2:

${table(BY_H)}

With H = L + 2:

${table(BY_L)}

${absences(context, PRINTED)}`;
}
