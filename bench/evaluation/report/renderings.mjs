// SPDX-License-Identifier: MIT
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { AMPLIFY, renderings } from '../experiments/pictures.mjs';
import { htmlTable } from './figure.mjs';
import { escape } from './plot.mjs';

function image(context, file, alt) {
  const data = readFileSync(join(context.folder, file)).toString('base64');
  return `<img src="data:image/webp;base64,${data}" alt="${escape(alt)}" width="512" height="512">`;
}

const markOf = ({ scheme, settings }) => [scheme, settings].filter(Boolean).join(', ');
const said = ({ most, mean }) => `pixels differ by ${most} of 255 at most, ${mean.toFixed(2)} on average`;

function ofModel(context, model, list) {
  const shown = list.filter(({ before }) => before);
  if (shown.length === 0) return '';
  const cells = shown.map(
    (one) => `<figure class="pair">
${image(context, one.after, `${model} marked by ${markOf(one)}`)}
${image(context, one.difference, `Difference to the original, ${AMPLIFY} times as strong: ${said(one)}`)}
<figcaption><b>${escape(markOf(one))}</b><br>${escape(said(one))}</figcaption></figure>`,
  );
  const original = image(context, shown[0].before, `${model} without a mark`);
  return `<h3>${escape(model)}</h3><div class="gallery">
<figure class="pair">${original}<figcaption><b>without a mark</b></figcaption></figure>
${cells.join('\n')}</div>`;
}

export function renderingSection(context) {
  const all = renderings(context);
  if (all.length === 0)
    return '<p>Nothing was drawn: <code>bench/evaluate --experiment pictures</code> needs Chromium.</p>';
  const models = [...new Set(all.map(({ model }) => model))];
  const rows = all.map((one) => [
    one.model,
    markOf(one),
    ...(one.note ? [one.note, '', ''] : [one.most, one.mean.toFixed(2), `${(100 * one.covered).toFixed(0)} %`]),
  ]);
  return `<p>A 64-bit ID in each, drawn by three.js in Chromium from one place; beside it what differs from the
original, ${AMPLIFY} times as strong as it is.</p>
${models
  .map((model) =>
    ofModel(
      context,
      model,
      all.filter((one) => one.model === model),
    ),
  )
  .join('\n')}
<details><summary>The numbers</summary>${htmlTable(['model', 'mark', 'largest difference, of 255', 'mean', 'covered'], rows)}</details>`;
}
