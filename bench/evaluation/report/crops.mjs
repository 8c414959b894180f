// SPDX-License-Identifier: MIT
// The paper's Fig. 5: what is read of a picture when more and more of the model is cut off.
import { existsSync, readFileSync } from 'node:fs';
import * as fig5 from '../experiments/fig5.mjs';
import { wasMeasured } from '../models.mjs';
import { curveFigure } from './curves.mjs';
import { escape } from './plot.mjs';
import { percent } from './statistics.mjs';

const NO_PICTURES =
  '<p>No pictures: they are written while the readings are measured, into the folder of the results.</p>';
const marksOf = (context) => fig5.marks(context).filter(({ model }) => wasMeasured(context, model));
const share = (attack) => (attack === 'none' ? 'whole' : `${percent(attack.split(':')[1])} off`);
const nameOf = ({ scheme, payload }) => `${scheme}, ${payload.slice('image:'.length)} pixels a side`;

function saidOf({ ber, unread } = {}) {
  if (ber === undefined || unread === 1) return 'not read';
  if (ber === 0) return 'all right';
  const wrong = ber - unread / 2; // an unread pixel counts as half a wrong one
  return [unread > 0 ? `${percent(unread)} unread` : '', wrong > 5e-5 ? `${percent(wrong)} wrong` : '']
    .filter(Boolean)
    .join(', '); // rows hold five digits
}

function picture(context, one) {
  if (!existsSync(one.file)) return '';
  const [row] = context.rows.select({
    scheme: one.scheme,
    settings: one.settings,
    payload: one.payload,
    model: one.model,
    attack: one.attack,
    seed: 1,
  });
  const said = saidOf(row);
  const data = readFileSync(one.file).toString('base64');
  const alt = escape(`The picture read from ${one.model}, ${share(one.attack)}: ${said}`);
  return `<figure class="read"><img src="data:image/png;base64,${data}" alt="${alt}">
<figcaption>${escape(share(one.attack))}<br>${escape(said)}</figcaption></figure>`;
}

function strips(context) {
  const all = fig5.pictures(context);
  return marksOf(context)
    .map((mark) => {
      const mine = all.filter(
        (one) => one.scheme === mark.scheme && one.payload === mark.payload && one.model === mark.model,
      );
      const shown = mine.map((one) => picture(context, one)).join('');
      const strip = shown ? `<div class="strip">${shown}</div>` : NO_PICTURES;
      return `<h3>${escape(`${mark.model}: ${nameOf(mark)}`)}</h3>${strip}`;
    })
    .join('\n');
}

export async function cropSection(context) {
  const marks = marksOf(context);
  const models = [...new Set(marks.map(({ model }) => model))];
  const attacks = ['none', ...fig5.CROPS.map((crop) => `crop:${crop}`)];
  const curves = await curveFigure({
    title: 'Wrong pixels by what is cut off',
    caption: `The lowest vertices along y go, with their faces. Medians over models (${models.join(', ')}) and keys, with
quartiles; unread pixels count one half, the dashed line is guessing.`,
    families: [
      {
        title: '',
        xTitle: 'vertices cut off',
        steps: attacks.map((attack) => ({
          label: share(attack),
          x: attack === 'none' ? '0' : percent(attack.split(':')[1]),
          attack,
        })),
      },
    ],
    series: [...new Set(marks.map(nameOf))].sort().reverse(), // robust first, as everywhere
    rowsOf: (name, { attack }) =>
      marks.filter((mark) => nameOf(mark) === name).flatMap((mark) => context.rows.select({ ...mark, attack })),
  });
  return `<p>As read with the first key; ink is black, grey is what could not be read.</p>${strips(context)}\n${curves}`;
}
