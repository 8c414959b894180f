// SPDX-License-Identifier: MIT
// Error rates after an attack of growing strength: a panel per attack, a curve per series.
import { figure, htmlTable } from './figure.mjs';
import { plot, seriesScales } from './plot.mjs';
import { entry, percent, summarizeColumn } from './statistics.mjs';

const ERRORS = {
  title: 'wrong bits',
  axis: { format: '.0%', values: [0, 0.25, 0.5] },
  scale: { domain: [0, 0.62], clamp: true },
};

/**
 * One panel's specification. Series stand beside each other within a place of the x axis, so that equal values are seen.
 * @param points   [{ x, series, median, low, high, trials }]: x is a text; low and high are drawn as a bar
 * @param order    the texts of x, in order
 * @param series   all series of the figure
 * @param ordered  false: the places of x have no order, and no lines between them
 */
export function curveSpec({ points, order, series, ordered = true, xTitle, y = ERRORS, rule = 0.5 }) {
  const { color, shape } = seriesScales(series);
  const x = {
    field: 'x',
    type: 'ordinal',
    scale: { domain: order, paddingInner: 0.25 },
    axis: { title: xTitle, labelOverlap: false, labelLimit: 120 },
  };
  const offset = { field: 'series', scale: { domain: series } };
  const place = (field) => ({ field, type: 'quantitative', ...y });
  return {
    width: Math.max(230, (ordered ? 50 : 68) * order.length),
    height: 190,
    data: { values: points },
    encoding: { x, xOffset: offset, color },
    layer: [
      ...(rule
        ? [
            {
              mark: { type: 'rule', strokeDash: [3, 3], color: 'var(--faint)' },
              data: { values: [{}] },
              encoding: { x: null, xOffset: null, color: null, y: { datum: rule } },
            },
          ]
        : []),
      ...(ordered && order.length > 1
        ? [{ mark: { type: 'line', opacity: 0.55 }, encoding: { y: place('median') } }]
        : []),
      { mark: { type: 'rule', strokeWidth: 1.5 }, encoding: { y: place('low'), y2: { field: 'high' } } },
      { mark: 'point', encoding: { y: place('median'), shape } },
    ],
  };
}

/**
 * A figure of several panels.
 * @param families  [{ title, xTitle, ordered, steps: [{ label, x, attack }] }]
 * @param series    names
 * @param rowsOf    (series, step) => rows of that cell, or [{ ber }] of a figure that somebody printed
 */
export async function curveFigure({ title, caption, families, series, rowsOf, column = 'ber' }) {
  const panels = [],
    tables = [];
  for (const { title: name, steps, xTitle, ordered } of families) {
    const cells = steps.map((step) => series.map((one) => ({ step, one, rows: rowsOf(one, step) })));
    const points = cells.flat().flatMap(({ step, one, rows }) => {
      const summary = summarizeColumn(rows, column);
      return summary ? [{ x: step.x, series: one, ...summary }] : [];
    });
    tables.push(
      htmlTable(
        [name, ...series],
        cells.map((row, i) => [steps[i].label, ...row.map(({ rows }) => entry(summarizeColumn(rows, column), rows))]),
      ),
    );
    if (points.length === 0) continue;
    const said = `${name}: ${points.map((point) => `${point.series} at ${point.x}: ${percent(point.median)}`).join('; ')}`;
    panels.push({
      title: name,
      svg: await plot(curveSpec({ points, order: steps.map(({ x }) => x), series, ordered, xTitle }), said),
    });
  }
  return figure({ title, caption, series, panels, tables });
}
