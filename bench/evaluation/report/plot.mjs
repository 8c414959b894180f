// SPDX-License-Identifier: MIT
// Plots by Vega-Lite, as SVG that takes its colours from the page: light, dark and printed are one picture.
import { parse, textMetrics, View } from 'vega';
import { compile } from 'vega-lite';

export const escape = (value) =>
  String(value).replace(/[&<>"]/g, (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[c]);

/** Colours (of report.css) and shapes of up to nine series, in their order. */
const COLOURS = Array.from({ length: 9 }, (_, i) => `var(--series-${i})`);
const SHAPES = [
  'circle',
  'square',
  'triangle-up',
  'diamond',
  'cross',
  'triangle-down',
  'triangle-right',
  'triangle-left',
  'wedge',
];

// Without a canvas Vega takes letters for much wider than those of a page are, and leaves room for them.
const WIDTH_OF_LETTER = 0.63; // of the size of the type, of sans serifs
textMetrics.width = (item, words) => WIDTH_OF_LETTER * item.fontSize * String(words ?? item.text ?? '').length;

/** Labels of a logarithmic axis, as a Vega expression. */
export const powerLabel = "datum.value === 1 ? '1' : format(datum.value, '~e')";

/** Scales that give each series the same look in all plots. */
export const seriesScales = (series) => ({
  color: {
    field: 'series',
    type: 'nominal',
    legend: null,
    scale: { domain: series, range: series.map((_, i) => COLOURS[i % COLOURS.length]) },
  },
  shape: {
    field: 'series',
    type: 'nominal',
    legend: null,
    scale: { domain: series, range: series.map((_, i) => SHAPES[i % SHAPES.length]) },
  },
});

const text = {
  labelColor: 'var(--ink)',
  titleColor: 'var(--ink)',
  labelFontSize: 12,
  titleFontSize: 12,
  titleFontWeight: 'normal',
};
const CONFIG = {
  aria: false, // the figure says in words what it shows
  background: null,
  font: 'inherit',
  view: { stroke: null },
  axis: { ...text, gridColor: 'var(--grid)', domainColor: 'var(--faint)', tickColor: 'var(--faint)', labelPadding: 4 },
  axisX: { labelAngle: 0, grid: false },
  point: { size: 55, filled: true, opacity: 1 },
  line: { strokeWidth: 2 },
};

/** What Vega writes for its own scripts says nothing in a still picture. */
const withoutRoles = (svg) =>
  svg
    .replace(/<path class="(?:background|foreground)"[^>]*\/>/g, '')
    .replace(/ (?:class|role|aria-[a-z]+|pointer-events|stroke-miterlimit)="[^"]*"/g, '')
    .replace(/ opacity="1"/g, '')
    .replace(/(\d\.\d{2})\d+/g, '$1');

/**
 * A Vega-Lite specification as SVG text of its own size that shrinks with its place.
 * @param label  what a reader who does not see it is told
 */
export async function plot(spec, label) {
  const view = new View(parse(compile({ ...spec, config: CONFIG }).spec), { renderer: 'none' });
  const svg = withoutRoles(await view.toSVG());
  view.finalize();
  const named = `<svg role="img" aria-label="${escape(label)}"`;
  return svg.replace('<svg', named).replace(/ version="1.1"| xmlns:xlink="[^"]*"/g, '');
}

/** A key to the series: a sample of each, drawn by the same library. */
export async function legend(series) {
  const scales = seriesScales(series);
  const samples = await Promise.all(
    series.map(
      async (one) =>
        `<li>${await plot(
          {
            data: {
              values: [
                { x: 0, series: one },
                { x: 1, series: one },
              ],
            },
            width: 26,
            height: 12,
            padding: 1,
            encoding: { x: { field: 'x', type: 'quantitative', axis: null }, color: scales.color },
            layer: [
              { mark: 'line' },
              { mark: 'point', encoding: { x: { datum: 0.5, axis: null }, shape: scales.shape } },
            ],
          },
          '',
        )} ${escape(one)}</li>`,
    ),
  );
  return `<ul class="legend">${samples.join('').replaceAll('role="img" aria-label=""', 'aria-hidden="true"')}</ul>`;
}
