// SPDX-License-Identifier: MIT
import { errorCell, measuredTable } from '../cells.mjs';
import { wasMeasured } from '../models.mjs';
import { absences, casesOf, PRINTED } from '../paper.mjs';

export const name = 'fig11';
export const title = 'Digits against noise, and noise on one half (the paper, Fig. 11)';

export const payload = 'image:24';
export const BY_H = [3, 4, 5, 6, 7].map((H) => `L=2 H=${H}`);
export const BY_L = [2, 3, 4, 5].map((L) => `L=${L} H=${L + 1}`);
export const NOISE = ['noise:1e-6', 'noise:1e-5'];
export const LOCAL = ['1e-5', '1e-4', '1e-3', '1e-2', '1e-1', '1'].map((amplitude) => ({ amplitude, attack: `local-noise:${amplitude}` }));
const bunny = PRINTED.filter(({ printed }) => printed === 'Bunny');
export const models = (context) => casesOf(context, bunny).map(({ model }) => model);

export const localMarks = (context) => models(context).flatMap((model) => [
  { scheme: 'paper', settings: 'L=2 H=3', payload, model }, { scheme: 'robust', settings: 'standard', payload, model },
]);

export const jobs = (context) => context.seeds.flatMap((seed) => [
  ...models(context).flatMap((model) => [...new Set([...BY_H, ...BY_L])].map((settings) => ({ scheme: 'paper', settings, payload, model, seed, attacks: NOISE }))),
  ...localMarks(context).map((mark) => ({ ...mark, seed, attacks: LOCAL.map(({ attack }) => attack) })),
]);

export function document(context) {
  const there = models(context).filter((model) => wasMeasured(context, model));
  const table = (list) => measuredTable(['digits', ...there.flatMap((model) => NOISE.map((attack) => `${model}, ${attack.replace(':', ' ')}`))],
    list.map((settings) => [settings, ...there.flatMap((model) => NOISE.map((attack) => errorCell(context.rows.select({ scheme: 'paper', settings, payload, model, attack }))))]));
  const halves = localMarks(context).filter(({ model }) => wasMeasured(context, model));
  return `24 x 24 pixels, bit error rates in percent. The paper's curves come without figures: with noise of "1e-5" on its Bunny, its
rate rises with H, sharply from 6 on, to a half at 7; it rises with L, too. With noise on half of the vertices it shows pictures that
are "still close to the original" at 1e-1 and 1e0.

With L = 2:

${table(BY_H)}

With H = L + 1:

${table(BY_L)}

Noise on half of the vertices:

${measuredTable(['amplitude', ...halves.map(({ scheme, model }) => `\`${scheme}\`, ${model}`)],
    LOCAL.map(({ amplitude, attack }) => [amplitude, ...halves.map((mark) => errorCell(context.rows.select({ ...mark, attack })))]))}

${absences(context, bunny)}`;
}
