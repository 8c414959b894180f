// SPDX-License-Identifier: MIT
// Writing CSV files as bench/README.md has them; csv-parse reads them.
import { mkdirSync, renameSync, writeFileSync } from 'node:fs';
import { dirname } from 'node:path';

/** A text as a field: on one line, quoted by RFC 4180 where it must be. */
export function textField(text) {
  const line = text.replace(/\s+/g, ' ');
  return /[",]/.test(line) ? `"${line.replaceAll('"', '""')}"` : line;
}

/** Writes a file anew, with its folder. Who is killed meanwhile leaves the old one. */
export function replaceFile(path, text) {
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(`${path}.new`, text);
  renameSync(`${path}.new`, path);
}
