// SPDX-License-Identifier: MIT
// Lists of recipients: CSV with a header line, read by csv-parse.
import { CsvError, parse } from 'csv-parse/sync';
import { QuadmarkError } from './error.js';
import { toRecipient } from './recipients.js';

const COLUMNS = ['recipient', 'image', 'folder'];

const fail = (name, line, what) => { throw new QuadmarkError('bad_file', `${name}, line ${line}: ${what}`); };

/**
 * Rows of a list of recipients. Columns: recipient (needed), image (path of a logo instead of an ID), folder (name of the
 * folder for the copy); others are ignored. Quotes, BOM, CRLF and empty lines are fine.
 * @param text  the CSV
 * @param name  of the file, for messages
 * @return [{ recipient, image?, folder?, line }]; fails with `bad_file` naming the line
 */
export function parseRecipients(text, name = 'list') {
  let rows;
  try {
    // csv-parse counts a CRLF inside quotes as two lines.
    rows = parse(text.replace(/\r\n?/g, '\n'), { bom: true, info: true, skip_empty_lines: true, trim: true, relax_column_count: true });
  } catch (error) {
    if (!(error instanceof CsvError)) throw error;
    fail(name, error.lines ?? 1, error.message);
  }
  const [head, ...body] = rows;
  if (head === undefined) fail(name, 1, 'the list is empty, expected a header with the column recipient');
  const columns = head.record.map((column) => column.toLowerCase());
  if (!columns.includes('recipient')) fail(name, head.info.lines, `no column recipient in the header (${head.record.join(', ')})`);
  for (const column of COLUMNS) {
    if (columns.indexOf(column) !== columns.lastIndexOf(column)) fail(name, head.info.lines, `the column ${column} is there twice`);
  }
  if (body.length === 0) fail(name, head.info.lines, 'nobody is in the list');
  const lines = new Map();
  return body.map(({ record, info: { lines: line } }) => {
    if (record.length !== columns.length) fail(name, line, `${record.length} values, but the header has ${columns.length} columns`);
    const row = Object.fromEntries(COLUMNS.filter((column) => columns.includes(column)).map((column) => [column, record[columns.indexOf(column)]]));
    let recipient;
    try {
      recipient = toRecipient(row.recipient);
    } catch (error) {
      fail(name, line, error.message);
    }
    if (lines.has(recipient)) fail(name, line, `${JSON.stringify(recipient)} is already on line ${lines.get(recipient)}`);
    lines.set(recipient, line);
    return { recipient, ...(row.image ? { image: row.image } : {}), ...(row.folder ? { folder: row.folder } : {}), line };
  });
}
