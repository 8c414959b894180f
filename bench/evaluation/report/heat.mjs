// SPDX-License-Identifier: MIT
// Heat maps of how many marks came back: by tool, and by affine map.
import { readings } from '../cells.mjs';
import * as fig10 from '../experiments/fig10.mjs';
import { wasMeasured } from '../models.mjs';
import { figure, htmlTable } from './figure.mjs';
import { plot } from './plot.mjs';
import { whyNothing } from './statistics.mjs';

/** { text, share }: how many were read exactly, of how many; "+n" more were recognised. */
function survived(rows) {
  const trials = readings(rows);
  if (trials.length === 0) return { text: whyNothing(rows), share: null, trials: 0 };
  const count = (outcome) => trials.filter((row) => row.outcome === outcome).length;
  const exact = count('exact'),
    match = count('match');
  return {
    text: `${exact}${match > 0 ? `+${match}` : ''} / ${trials.length}`,
    share: exact / trials.length,
    known: (exact + match) / trials.length,
    trials: trials.length,
  };
}

const GRADES = ['none', 'few', 'known', 'most', 'all', 'missing'];
const GRADE_WORDS = {
  all: 'all read exactly',
  most: 'half and more',
  known: 'recognised, hardly read',
  few: 'some',
  none: 'none',
};
const byGrade = (colour) => ({
  field: 'grade',
  type: 'nominal',
  legend: null,
  scale: { domain: GRADES, range: GRADES.map((grade) => `var(--${colour}-${grade})`) },
});

/** @param narrow  whether the names of the rows stand above them, for phones */
function spec(cells, rows, columns, narrow) {
  const columnAxis = {
    orient: 'top',
    labelAngle: 0,
    ticks: false,
    domain: false,
    labelLimit: 0,
    labelExpr: "split(datum.label, ' ')", // word by word, one below the other, downwards
    labelPadding: 4 + 14 * (Math.max(...columns.map((name) => name.split(' ').length)) - 1),
  };
  const rowAxis = { ticks: false, domain: false, labelLimit: 0 };
  const y = {
    field: 'row',
    type: 'nominal',
    sort: rows,
    title: null,
    axis: narrow ? null : rowAxis,
    scale: narrow ? { paddingInner: 0.48, paddingOuter: 0.5 } : {},
  };
  const longest = Math.max(...columns.flatMap((name) => name.split(' ')).map((word) => word.length));
  return {
    width: { step: Math.max(narrow ? 56 : 66, 6.4 * longest) },
    height: { step: narrow ? 44 : 25 },
    data: { values: cells },
    encoding: { x: { field: 'column', type: 'nominal', sort: columns, title: null, axis: columnAxis }, y },
    layer: [
      { mark: { type: 'rect', stroke: 'var(--card)', strokeWidth: 2 }, encoding: { fill: byGrade('grade') } },
      { mark: { type: 'text', fontSize: 12 }, encoding: { text: { field: 'shown' }, color: byGrade('on') } },
      ...(narrow
        ? [
            {
              data: { values: rows.map((row) => ({ row })) },
              mark: { type: 'text', align: 'left', dy: -18, fontSize: 12, color: 'var(--ink)' },
              encoding: { x: { value: 1 }, text: { field: 'row' } },
            },
          ]
        : []),
    ],
    resolve: { scale: { color: 'independent' } },
  };
}

function gradeOf({ share, known }) {
  if (share === null) return 'missing';
  if (share === 1) return 'all';
  if (share >= 0.5) return 'most';
  if (known >= 0.9) return 'known';
  return share > 0 || known > 0 ? 'few' : 'none';
}

async function heatFigure({ title, caption, rows, columns, rowsOf }) {
  const cells = rows.flatMap((row) =>
    columns.map((column) => {
      const cell = survived(rowsOf(row, column));
      return {
        row,
        column,
        ...cell,
        grade: gradeOf(cell),
        shown: cell.share === null ? cell.text.split(':')[0] : cell.text,
      };
    }),
  );
  const said = cells.map(({ row, column, text }) => `${row}, ${column}: ${text}`).join('; ');
  const key = `<ul class="legend grades">${Object.entries(GRADE_WORDS)
    .map(([grade, words]) => `<li><i data-grade="${grade}"></i>${words}</li>`)
    .join('')}</ul>`;
  return figure({
    title,
    caption,
    tables: [
      htmlTable(
        [title, ...columns],
        rows.map((row) => [row, ...cells.filter((cell) => cell.row === row).map(({ text }) => text)]),
      ),
    ],
    panels: [
      {
        title: '',
        wide: true,
        svg: `${key}<div class="scroll wide" tabindex="0">${await plot(spec(cells, rows, columns, false), `${title}: ${said}`)}</div>
<div class="scroll narrow" tabindex="0">${await plot(spec(cells, rows, columns, true), `${title}: ${said}`)}</div>`,
      },
    ],
  });
}

export async function toolSection(context) {
  const all = context.rows.select({ attack: (attack) => attack.startsWith('tool:') });
  if (all.length === 0) return '<p>No tool has been measured: <code>bench/evaluate --experiment tools</code>.</p>';
  const lineOf = ({ attack }) => attack.slice('tool:'.length),
    columnOf = ({ scheme, settings }) => (scheme === 'robust' ? `${scheme} ${settings}` : scheme);
  const order = context.schemes.map(({ name }) => name);
  const columns = [
    ...new Set([...all].sort((a, b) => order.indexOf(a.scheme) - order.indexOf(b.scheme)).map(columnOf)),
  ];
  return heatFigure({
    title: 'Marks that come back after a real program',
    columns,
    rows: [...new Set(all.map(lineOf))],
    caption:
      `64-bit IDs: read exactly, "+n" more recognised when the ID is expected, of how many trials. What could not be run
says so in the table behind.`,
    rowsOf: (line, column) => all.filter((row) => lineOf(row) === line && columnOf(row) === column),
  });
}

export async function affineSection(context) {
  const marks = fig10.marks(context).filter(({ model }) => wasMeasured(context, model));
  const nameOf = ({ scheme, model }) => `${scheme}: ${model}`;
  const attacks = {
    ...Object.fromEntries(
      Object.entries(fig10.MAPS).map(([map, words]) => [`${map}: ${words.split(/ by |,/)[0]}`, `affine::${map}`]),
    ),
    [`${fig10.ORDERS.length} orders`]: fig10.ORDERS,
  };
  return heatFigure({
    title: 'Affine maps and orders',
    rows: Object.keys(attacks),
    columns: marks.map(nameOf),
    caption: 'Trials of which every bit was read, of how many.',
    rowsOf: (name, column) => {
      const mark = marks.find((one) => nameOf(one) === column);
      return context.rows.select({
        scheme: mark.scheme,
        settings: mark.settings,
        payload: mark.payload,
        model: mark.model,
        attack: attacks[name],
      });
    },
  });
}
