// SPDX-License-Identifier: MIT
// Tables that a command writes into a page, between <!-- name --> and <!-- /name -->.
import { readFileSync, writeFileSync } from 'node:fs';

/** A Markdown table of text. */
export const tableOf = (head, rows) => [head, head.map(() => '---'), ...rows].map((row) => `| ${row.join(' | ')} |`).join('\n');

/** Replaces the part `name` of a page; throws when the page has none. */
export function replaceTable(page, name, text) {
  const before = readFileSync(page, 'utf8');
  const [from, to] = [`<!-- ${name} -->\n`, `<!-- /${name} -->`];
  const [begin, end] = [before.indexOf(from), before.indexOf(to)];
  if (begin < 0 || end < begin) throw new Error(`${page} has no part ${name}`);
  writeFileSync(page, `${before.slice(0, begin + from.length)}${text}\n${before.slice(end)}`);
}
