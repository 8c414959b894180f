// SPDX-License-Identifier: MIT
import { join } from 'node:path';
import { errorCell, measuredTable } from '../cells.mjs';
import { wasMeasured } from '../models.mjs';
import { absences, casesOf, PRINTED } from '../paper.mjs';

export const name = 'fig5';
export const title = 'Cropping (the paper, Fig. 5)';

export const CROPS = [0.1, 0.3, 0.5, 0.7, 0.8, 0.85, 0.9, 0.9211, 0.95];
const attacks = ['none', ...CROPS.map((share) => `crop:${share}`)];
const cases = [...PRINTED, { model: 'sculpture:40000:3', settings: 'L=2' }];
const picturedSeed = 1;

/** The schemes and payloads that are put to it. */
export const marks = (context) => casesOf(context, cases).flatMap(({ model, settings }) => [
  { scheme: 'paper', settings, payload: context.quick ? 'image:24' : 'image:90', model },
  { scheme: 'robust', settings: 'standard', payload: 'image:24', model },
]);

/** The image of each reading of the first seed: [{ scheme, payload, model, attack, file }]. */
export const pictures = (context) => marks(context).flatMap((mark) => attacks.map((attack) =>
  ({ ...mark, attack, file: join(context.folder, 'pictures', `${[mark.scheme, mark.payload, mark.model, attack].join('-').replace(/[^\w.-]/g, '_')}.png`) })));

export const jobs = (context) => marks(context).flatMap((mark) => context.seeds.map((seed) => ({
  ...mark, seed, attacks,
  pictures: seed === picturedSeed
    ? Object.fromEntries(pictures(context).filter((one) => one.scheme === mark.scheme && one.model === mark.model).map(({ attack, file }) => [attack, file]))
    : {},
})));

export function document(context) {
  const there = marks(context).filter(({ model }) => wasMeasured(context, model));
  const head = ['vertices cut off', ...there.map(({ scheme, payload, model }) => `\`${scheme}\`, ${payload}, ${model}`)];
  const cells = (attack) => there.map((mark) => errorCell(context.rows.select({ ...mark, attack })));
  return `Bit error rates in percent; the lowest vertices along y are cut off with the faces that use them. The paper shows the Bunny's
90 x 90 pixels at up to 92.11 %, "clearly distinguishable", without figures; pixels that could not be read count one half
here, and are grey in the pictures of the report. Fandisk has too few cells for 8100 bits to be stored twice.

${measuredTable(head, [['none', ...cells('none')], ...CROPS.map((share) => [`${+(100 * share).toFixed(2)} %`, ...cells(`crop:${share}`)])])}

${absences(context, cases)}`;
}
