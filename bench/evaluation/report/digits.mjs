// SPDX-License-Identifier: MIT
// The paper's Figs. 9 and 11: what the digits L and H cost and bring.
import { wasMeasured } from '../models.mjs';
import * as fig11 from '../experiments/fig11.mjs';
import * as fig9 from '../experiments/fig9.mjs';
import { curveFigure, curveSpec } from './curves.mjs';
import { figure, htmlTable } from './figure.mjs';
import { plot, seriesScales } from './plot.mjs';
import { entry, summarizeColumn } from './statistics.mjs';

const digits = (settings) => settings.replace(/[LH]=/g, '').split(' ');
const byH = (settings) => digits(settings)[1],
  byL = (settings) => digits(settings)[0];
const MEASURES = [
  ['hausdorff', 'Hausdorff distance', 'of the diagonal', (x) => x.toExponential(2), '.0e'],
  ['snr', 'SNR', 'dB', (x) => x.toFixed(1), 'd'],
];

function scatter(points, series) {
  const { color, shape } = seriesScales(series);
  return {
    width: 300,
    height: 190,
    data: { values: points },
    encoding: {
      x: {
        field: 'capacity',
        type: 'quantitative',
        scale: { type: 'log', nice: false, padding: 12 },
        axis: { title: 'capacity, bits', tickCount: 4, format: '~s' },
      },
      y: { field: 'snr', type: 'quantitative', scale: { zero: false, padding: 8 }, title: 'SNR, dB' },
      color,
    },
    layer: [
      { mark: 'point', encoding: { shape } },
      { mark: { type: 'text', dy: -11, fontSize: 10 }, encoding: { text: { field: 'label' } } },
    ],
  };
}

export async function capacitySection(context) {
  const series = fig9.models(context).filter((model) => wasMeasured(context, model));
  const marks = (model, settings) =>
    context.rows.select({ scheme: 'paper', settings, payload: fig9.payload, model, attack: 'mark' });
  const panels = [],
    tables = [];
  for (const [list, x, xTitle] of [
    [fig9.BY_H, byH, 'H, with L = 2'],
    [fig9.BY_L, byL, 'L, with H = L + 2'],
  ]) {
    for (const [column, title, unit, show, format] of MEASURES) {
      const points = list.flatMap((settings) =>
        series.flatMap((model) => {
          const summary = summarizeColumn(marks(model, settings), column);
          return summary ? [{ x: x(settings), series: model, ...summary }] : [];
        }),
      );
      tables.push(
        htmlTable(
          [`${title}, ${unit}; ${xTitle}`, ...series],
          list.map((settings) => [
            settings,
            ...series.map((model) =>
              entry(summarizeColumn(marks(model, settings), column), marks(model, settings), show),
            ),
          ]),
        ),
      );
      if (points.length === 0) continue;
      const y = { title: unit, axis: { format }, scale: { zero: false } };
      panels.push({
        title: `${title} by ${xTitle[0]}`,
        svg: await plot(
          curveSpec({ points, order: list.map(x), series, xTitle, y, rule: null }),
          `${title} by ${xTitle}: ${points.map((point) => `${point.series} ${point.x}: ${show(point.median)}`).join('; ')}`,
        ),
      });
    }
  }
  const both = [...new Set([...fig9.BY_H, ...fig9.BY_L])].flatMap((settings) =>
    series.flatMap((model) => {
      const capacity = summarizeColumn(marks(model, settings), 'capacity'),
        snr = summarizeColumn(marks(model, settings), 'snr');
      return capacity && snr
        ? [
            {
              series: model,
              label: digits(settings).join('-'),
              capacity: capacity.median,
              snr: snr.median,
              trials: snr.trials,
            },
          ]
        : [];
    }),
  );
  if (both.length > 0) {
    panels.push({
      title: 'Distortion against capacity',
      svg: await plot(
        scatter(both, series),
        `SNR against capacity, labelled L-H: ${both.map((point) => `${point.series} ${point.label}: ${point.capacity} bits, ${point.snr.toFixed(1)} dB`).join('; ')}`,
      ),
    });
    tables.push(
      htmlTable(
        ['model', 'L-H', 'capacity, bits', 'SNR, dB', 'trials'],
        both.map((one) => [one.series, one.label, one.capacity, one.snr.toFixed(1), one.trials]),
      ),
    );
  }
  return figure({
    title: 'Digits, distortion and capacity',
    series,
    panels,
    tables,
    caption:
      `Scheme paper, 24 x 24 pixels: medians over keys with quartiles. The paper gives its curves without figures: the
distance grows with H and hardly so beyond 5, and falls with L.`,
  });
}

export async function noiseSection(context) {
  const models = fig11.models(context).filter((model) => wasMeasured(context, model));
  const names = fig11.NOISE.map((attack) => attack.replace(':', ' '));
  const ofPaper = (attack, settings) =>
    models.flatMap((model) =>
      context.rows.select({ scheme: 'paper', settings, payload: fig11.payload, model, attack }),
    );
  const family = (title, xTitle, list, x) => ({
    title,
    xTitle,
    steps: list.map((settings) => ({ label: settings, settings, x: x(settings) })),
  });
  const byDigits = await curveFigure({
    title: 'Digits and noise',
    caption: `Scheme paper, 24 x 24 pixels in ${models.join(', ')}, noise relative to the diagonal: medians over keys
with quartiles; the dashed line is guessing.`,
    families: [
      family('More digits', 'H, with L = 2', fig11.BY_H, byH),
      family('Finer digits', 'L, with H = L + 1', fig11.BY_L, byL),
    ],
    series: names,
    rowsOf: (name, { settings }) => ofPaper(fig11.NOISE[names.indexOf(name)], settings),
  });
  const local = fig11.localMarks(context).filter(({ model }) => wasMeasured(context, model));
  const onHalf = await curveFigure({
    title: 'Noise on one half',
    caption: `24 x 24 pixels in ${models.join(', ')}: half of the vertices disturbed, medians over keys with
quartiles.`,
    families: [
      {
        title: '',
        xTitle: 'amplitude, of the diagonal',
        steps: fig11.LOCAL.map(({ amplitude, attack }) => ({ label: amplitude, x: amplitude, attack })),
      },
    ],
    series: [...new Set(local.map(({ scheme }) => scheme))].sort().reverse(), // robust first, as everywhere
    rowsOf: (scheme, { attack }) =>
      local.filter((mark) => mark.scheme === scheme).flatMap((mark) => context.rows.select({ ...mark, attack })),
  });
  return `${byDigits}\n${onHalf}`;
}
