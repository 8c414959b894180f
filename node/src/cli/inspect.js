// SPDX-License-Identifier: MIT
// quadmark inspect: facts about models, without a key.
import { EXIT, worstExit } from './exit.js';
import { displayName, readModelFile } from './files.js';
import { expandGlobs } from './glob.js';
import { millisSince } from './output.js';
import { forEachInput, jobCount } from './pool.js';

export async function inspectCommand(files, options, output) {
  let inputs;
  try {
    inputs = expandGlobs(files);
  } catch (error) {
    return output.failure(null, error);
  }
  const statuses = await forEachInput(
    inputs, jobCount(options.jobs, inputs.length),
    (input, { inspect }) => inspectOne(input, output, inspect),
    (input, error) => output.failure(input, error));
  return worstExit(statuses);
}

/** Reads one model; the function it returns prints the result. */
async function inspectOne(input, output, inspect) {
  const start = performance.now();
  const { bytes, resources } = await readModelFile(input);
  const report = await inspect(bytes, { resources });
  const millis = millisSince(start);
  return () => {
    output.result({ input, ...report, millis }, describe(input, report));
    return EXIT.done;
  };
}

/** Every plain value of the report, one per line, and one line per item of a list; what it has is the core's to decide. */
function describe(input, report) {
  const lines = [`${displayName(input)}:`];
  const walk = (object, indent) => {
    for (const [name, value] of Object.entries(object)) {
      if (name === 'warnings') continue;
      if (Array.isArray(value)) {
        if (value.length === 0) continue;
        if (typeof value[0] !== 'object') {
          lines.push(`${indent}${name}: ${value.join(', ')}`);
          continue;
        }
        lines.push(`${indent}${name}:`);
        for (const item of value) {
          lines.push(`${indent}  ${Object.entries(item).map(([key, part]) => `${key} ${part === '' ? '""' : part}`).join(', ')}`);
        }
      } else if (typeof value === 'object' && value !== null) {
        lines.push(`${indent}${name}:`);
        walk(value, `${indent}  `);
      } else {
        lines.push(`${indent}${name}: ${value}`);
      }
    }
  };
  walk(report, '  ');
  return lines;
}
