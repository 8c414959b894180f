// SPDX-License-Identifier: MIT
// What each scheme does to a model, in every measure.
import { wasMeasured } from '../models.mjs';
import { marks, models } from '../experiments/distortion.mjs';
import { figure, htmlTable } from './figure.mjs';
import { plot, powerLabel, seriesScales } from './plot.mjs';
import { entry, summarizeColumn } from './statistics.mjs';

const MEASURES = [
  ['rms', 'surface RMS, of the diagonal', (x) => x.toExponential(1), '~e', 'log'],
  ['hausdorff', 'Hausdorff distance, of the diagonal', (x) => x.toExponential(1), '~e', 'log'],
  ['max', 'largest move, of the diagonal', (x) => x.toExponential(1), '~e', 'log'],
  ['snr', 'SNR, dB', (x) => x.toFixed(1), 'd', 'linear'],
  ['normals', 'normals turned, degrees', (x) => x.toFixed(2), '~e', 'log'],
  ['msdm2', 'MSDM2', (x) => x.toFixed(3), '~g', 'linear'],
];
const nameOf = ({ scheme, settings }) => (scheme === 'robust' ? `robust ${settings}` : scheme);

function spec(points, order, series, title, format, scale) {
  const { color, shape } = seriesScales(series);
  return {
    width: 240,
    height: { step: 24 },
    data: { values: points },
    encoding: {
      x: {
        field: 'median',
        type: 'quantitative',
        title,
        scale: { type: scale, ...(scale === 'linear' ? { zero: false } : {}), nice: false, padding: 10 },
        axis: { grid: true, tickCount: 4, ...(scale === 'log' ? { labelExpr: powerLabel } : { format }) },
      },
      y: {
        field: 'name',
        type: 'nominal',
        sort: order,
        scale: { domain: order },
        title: null,
        axis: { grid: true, ticks: false, domain: false },
      },
    },
    layer: [
      { mark: 'point', encoding: { color, shape } },
      {
        mark: { type: 'tick', color: 'var(--ink)', thickness: 2, height: 16 },
        encoding: { x: { aggregate: 'median', field: 'median', title } },
      },
    ],
  };
}

export async function distortionSection(context) {
  const there = models(context).filter((model) => wasMeasured(context, model)),
    all = marks(context),
    order = all.map(nameOf);
  const panels = [],
    tables = [];
  for (const [column, title, show, format, scale] of MEASURES) {
    const cells = all.map((mark) =>
      there.map((model) => ({ mark, model, rows: context.rows.select({ ...mark, model, attack: 'mark' }) })),
    );
    const points = cells.flat().flatMap(({ mark, model, rows }) => {
      const summary = summarizeColumn(rows, column);
      return summary && (scale === 'linear' || summary.median > 0)
        ? [{ name: nameOf(mark), series: model, ...summary }]
        : [];
    });
    tables.push(
      htmlTable(
        [title, ...there],
        cells.map((row, i) => [order[i], ...row.map(({ rows }) => entry(summarizeColumn(rows, column), rows, show))]),
      ),
    );
    if (points.length === 0) continue;
    panels.push({
      title,
      svg: await plot(
        spec(points, order, there, null, format, scale),
        `${title}: ${points.map((point) => `${point.name} on ${point.series}: ${show(point.median)}`).join('; ')}`,
      ),
    });
  }
  return figure({
    title: 'Schemes at their usual settings',
    series: there,
    panels,
    tables,
    caption:
      `64-bit IDs. A point is a model (median over keys), the bar the median of the models. To the left there is less
distortion, except for SNR.`,
  });
}
