// SPDX-License-Identifier: MIT
// Cells and tables of the document. A cell keeps the number of its trials: one that all cells of a table share is said once.
import { tableOf } from '../support/table.mjs';

const mean = (list) => list.reduce((sum, x) => sum + x, 0) / list.length;
const percent = (share) => (share === 0 ? '0' : share < 0.0005 ? '<.05' : (100 * share).toFixed(1).replace(/^0\./, '.'));

/** Rows of one cell that say something: neither refused nor of a tool that failed. */
export const readings = (rows) => rows.filter((row) => row.outcome !== 'refused' && row.outcome !== 'failed');

function without(rows) {
  if (rows.length === 0) return { text: 'not measured', trials: null };
  if (rows.every((row) => row.outcome === 'refused')) return { text: 'refused', trials: rows.length };
  return { text: 'failed', trials: rows.length };
}

/** Mean bit error rate in percent; "exact" where every bit of every trial was right and known to be. */
export function errorCell(rows) {
  const read = readings(rows);
  if (read.length === 0) return without(rows);
  const wrong = read.filter((row) => row.outcome === 'wrong').length;
  const text = read.every((row) => row.outcome === 'exact') ? 'exact' : percent(mean(read.map((row) => row.ber)));
  return { text: wrong > 0 ? `${text} (**${wrong} wrong**)` : text, trials: read.length };
}

/** How many trials came back whole; "+n": so many more were recognised only. */
export function recoveredCell(rows) {
  const read = readings(rows);
  if (read.length === 0) return without(rows);
  const number = (outcome) => read.filter((row) => row.outcome === outcome).length;
  const match = number('match'), wrong = number('wrong');
  return { text: `${number('exact')}${match > 0 ? ` + ${match}` : ''}${wrong > 0 ? ` (**${wrong} wrong**)` : ''}`, trials: read.length };
}

/** Mean of a column. @param show  the mean as text */
export function meanCell(rows, column, show) {
  const values = rows.map((row) => row[column]).filter((value) => value !== undefined);
  return values.length === 0 ? without(rows) : { text: show(mean(values)), trials: values.length };
}

/**
 * A Markdown table with the number of trials: once below it where all cells have the same, else in each cell. A sentence
 * where none of its cells was measured.
 * @param rows  lists of texts and cells
 */
export function measuredTable(head, rows) {
  if (!rows.flat().some((cell) => cell?.trials)) return 'Not measured: the run ended before it.';
  const counts = new Set(rows.flat().filter((cell) => cell?.trials > 0).map((cell) => cell.trials));
  const common = counts.size === 1;
  const show = (cell) => {
    if (typeof cell !== 'object') return String(cell);
    return common || !cell.trials ? cell.text : `${cell.text} (${cell.trials})`;
  };
  const said = counts.size === 0 ? '' : common
    ? `\n\n${[...counts][0]} trial${[...counts][0] === 1 ? '' : 's'} per cell.`
    : '\n\nIn parentheses: the number of trials.';
  return `${tableOf(head, rows.map((row) => row.map(show)))}${said}`;
}
