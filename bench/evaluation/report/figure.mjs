// SPDX-License-Identifier: MIT
// A figure of the report: panels, what they show in words, and the numbers behind them as a table.
import { escape, legend } from './plot.mjs';

/** A table in HTML. @param head  texts; @param rows  lists of texts, the first one names the row */
export function htmlTable(head, rows) {
  const cell = (tag, scope) => (value) => `<${tag}${scope ? ` scope="${scope}"` : ''}>${escape(value)}</${tag}>`;
  const body = rows
    .map(([name, ...values]) => `<tr>${cell('th', 'row')(name)}${values.map(cell('td')).join('')}</tr>`)
    .join('');
  const first = head.map(cell('th', 'col')).join('');
  return `<div class="scroll" tabindex="0"><table><thead><tr>${first}</tr></thead><tbody>${body}</tbody></table></div>`;
}

/**
 * @param title, caption  texts; the caption says how to read it
 * @param series          names of the series for the key; none: no key
 * @param panels          [{ title, svg }]
 * @param tables          HTML of htmlTable()
 */
export async function figure({ title, caption, series = [], panels, tables = [] }) {
  const grid = panels
    .map(
      (panel) =>
        `<div class="panel"${panel.wide ? ' data-wide' : ''}>${panel.title ? `<h4>${escape(panel.title)}</h4>` : ''}${panel.svg}</div>`,
    )
    .join('\n');
  return `<figure>
<figcaption><h3>${escape(title)}</h3><p>${escape(caption)}</p></figcaption>
${series.length > 0 ? await legend(series) : ''}
<div class="panels">${grid}</div>
${tables.length > 0 ? `<details><summary>The numbers</summary>${tables.join('\n')}</details>` : ''}
</figure>`;
}
