// SPDX-License-Identifier: MIT
import { errorCell, measuredTable } from '../cells.mjs';
import { wasMeasured } from '../models.mjs';
import { absences, casesOf, PRINTED } from '../paper.mjs';

export const name = 'fig10';
export const title = 'Affine maps and reordering (the paper, Fig. 10)';

export const MAPS = { R: 'rotated by 45 degrees about x, then y', NS: 'scaled by .5, 1.5, 2', RE: 'mirrored', S: 'scaled by .5', SH: "sheared, x' = x + 1.5 y", CB: 'all of these' };
export const ORDERS = Array.from({ length: 10 }, (_, i) => `reorder:${i + 1}`);
const attacks = [...Object.keys(MAPS).map((map) => `affine::${map}`), ...ORDERS];
const cases = [...PRINTED, { model: 'sculpture:40000:3', settings: 'L=2' }];

export const marks = (context) => casesOf(context, cases).flatMap(({ model, settings }) => [
  { scheme: 'paper', settings, payload: context.quick ? 'image:24' : 'image:90', model },
  { scheme: 'robust', settings: 'standard', payload: 'id', model },
]);

export const jobs = (context) => marks(context).flatMap((mark) => context.seeds.map((seed) => ({ ...mark, seed, attacks })));

export function document(context) {
  const there = marks(context).filter(({ model }) => wasMeasured(context, model));
  const cells = (attack) => there.map((mark) => errorCell(context.rows.select({ ...mark, attack })));
  return `Bit error rates in percent, maps applied in float32. The paper: 0 for all maps and for 50 orders.

${measuredTable(['attack', ...there.map(({ scheme, payload, model }) => `\`${scheme}\`, ${payload}, ${model}`)],
    [...Object.entries(MAPS).map(([map, words]) => [`${map}: ${words}`, ...cells(`affine::${map}`)]), [`${ORDERS.length} orders per seed`, ...cells(ORDERS)]])}

${absences(context, cases)}`;
}
