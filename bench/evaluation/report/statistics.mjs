// SPDX-License-Identifier: MIT
// Rows of one cell as a point of a plot and as an entry of the table behind it.

/** The quantile of a sorted list, between its neighbours. */
function quantile(sorted, share) {
  const at = share * (sorted.length - 1),
    low = Math.floor(at);
  return sorted[low] + (at - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
}

/** { median, low, high, trials } of a list, low and high its quartiles; null of none. */
export function summarize(values) {
  if (values.length === 0) return null;
  const sorted = [...values].sort((a, b) => a - b);
  return {
    median: quantile(sorted, 0.5),
    low: quantile(sorted, 0.25),
    high: quantile(sorted, 0.75),
    trials: sorted.length,
  };
}

/** Of a column of some rows. */
export const summarizeColumn = (rows, column) =>
  summarize(rows.map((row) => row[column]).filter((value) => value !== undefined));

/** Why rows have no value: "not measured", or what they say themselves. */
export function whyNothing(rows) {
  if (rows.length === 0) return 'not measured';
  const notes = [...new Set(rows.map(({ outcome, note }) => (note ? `${outcome}: ${note}` : outcome)))];
  return notes.join('; ');
}

export const percent = (share) => `${Number((100 * share).toPrecision(3))}\u00a0%`;

/** "3.5 % (15)": the median and how many trials it is of; or why there is none. @param show  the median as text */
export function entry(summary, rows, show = percent) {
  return summary ? `${show(summary.median)} (${summary.trials})` : whyNothing(rows);
}
