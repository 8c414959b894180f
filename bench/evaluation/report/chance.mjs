// SPDX-License-Identifier: MIT
// How often chance claims to be a mark, against how often it says it may.
import { atMost } from '../chance_rows.mjs';
import { summaries } from '../experiments/chance.mjs';
import { figure, htmlTable } from './figure.mjs';
import { plot, powerLabel, seriesScales } from './plot.mjs';

const EXPONENTS = Array.from({ length: 41 }, (_, i) => -i / 10); // 1 .. 1e-4
const SHOWN = [-0.3, -1, -2, -3, -4];
const CONFIDENCE = 1.96; // standard deviations: 95 %

/** Where the share of `trials` trials lies with 95 % probability if each claims at most p with probability p. */
function band(p, trials) {
  const half = CONFIDENCE * Math.sqrt((p * (1 - p)) / trials);
  return { claimed: p, low: Math.max(p - half, 0.3 / trials), high: Math.min(1, Math.max(p + half, 1 / trials)) };
}

function spec(curves, series) {
  const { color, shape } = seriesScales(series);
  const trials = Math.min(...curves.map((one) => one.trials));
  const least = 10 ** Math.floor(Math.log10(0.5 / Math.max(...curves.map((one) => one.trials))));
  const points = curves.flatMap(({ words, bins, trials: all }) =>
    EXPONENTS.map((exponent) => ({
      series: words,
      claimed: 10 ** exponent,
      observed: atMost(bins, exponent) / all,
      whole: Number.isInteger(exponent * 2),
    })),
  );
  const decades = Array.from({ length: 1 - Math.round(Math.log10(least)) }, (_, i) => 10 ** -i);
  const log = (field, title) => ({
    field,
    type: 'quantitative',
    title,
    scale: { type: 'log', domain: [least, 1], clamp: true },
    axis: { grid: true, labelExpr: powerLabel, values: decades },
  });
  return {
    width: 250,
    height: 220,
    data: { values: points.filter(({ observed }) => observed > 0) },
    encoding: { x: log('claimed', 'claimed probability') },
    layer: [
      {
        mark: { type: 'area', color: 'var(--faint)', opacity: 0.18 },
        data: { values: EXPONENTS.map((exponent) => band(10 ** exponent, trials)) },
        encoding: { y: log('low', 'observed share'), y2: { field: 'high' } },
      },
      {
        mark: { type: 'line', color: 'var(--faint)', strokeDash: [4, 3] },
        data: { values: [{ claimed: least }, { claimed: 1 }] },
        encoding: { y: log('claimed', 'observed share') },
      },
      { mark: { type: 'line', interpolate: 'step-after' }, encoding: { y: log('observed', 'observed share'), color } },
      {
        mark: { type: 'point', size: 40 },
        transform: [{ filter: 'datum.whole' }],
        encoding: { y: log('observed', 'observed share'), color, shape },
      },
    ],
  };
}

const share = (count, trials) => (count === 0 ? '0' : (count / trials).toPrecision(2));

export async function chanceSection(context) {
  const all = summaries(context),
    series = [...new Set(all.map(({ words }) => words))];
  const panels = [];
  for (const { name } of context.schemes) {
    const curves = all.filter(({ scheme, trials }) => scheme === name && trials);
    if (curves.length === 0) continue;
    panels.push({
      title: name,
      svg: await plot(
        spec(curves, series),
        `${name}: observed share of trials at a claimed probability of .1, .01, .001: ${curves
          .map(
            ({ words, bins, trials }) =>
              `${words}, ${trials} trials: ${[-1, -2, -3].map((exponent) => share(atMost(bins, exponent), trials)).join(', ')}`,
          )
          .join('; ')}`,
      ),
    });
  }
  const rows = all.map(({ scheme, words, trials, bins, matches, least, notes }) => [
    `${scheme}, ${words}`,
    ...(trials === undefined
      ? [notes.join('; ') || 'not measured', ...SHOWN.map(() => ''), '', '', '']
      : [
          trials,
          ...SHOWN.map((exponent) => share(atMost(bins, exponent), trials)),
          matches,
          least.toExponential(1),
          Math.min(1, least * trials).toPrecision(2),
        ]),
  ]);
  return figure({
    title: 'Claimed and observed',
    series,
    panels,
    caption:
      `Share of the trials whose claim was at most what the x axis says. On the dashed line claims are exact, below it
they are cautious, above the grey band (95 % for the fewest trials of the panel) they would be false. Trials of a kind
are of all models together; where no trial claimed so little, there is no line.`,
    tables: [
      htmlTable(
        [
          'scheme, trials',
          'trials',
          ...SHOWN.map((exponent) => `<= ${Number((10 ** exponent).toPrecision(1))}`),
          'taken for a mark',
          'least claim',
          'times trials',
        ],
        rows,
      ),
    ],
  });
}
