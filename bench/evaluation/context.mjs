// SPDX-License-Identifier: MIT
// What documents and reports are made of, without measuring anything.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { Rows } from './rows.mjs';

export const rowsFile = (folder) => join(folder, 'readings.csv');
export const machineFile = (folder) => join(folder, 'machine.json');

/** The context of a run that ended: { quick, schemes, rows, folder, machine } (experiments.mjs). */
export function recordedContext(folder, { quick = false } = {}) {
  const machine = JSON.parse(readFileSync(machineFile(folder), 'utf8'));
  return { quick, schemes: machine.schemes, rows: new Rows(rowsFile(folder)), folder, machine };
}
