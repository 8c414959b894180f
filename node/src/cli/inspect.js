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
  output.expect(inputs.length);
  const statuses = await forEachInput(
    inputs, jobCount(options.jobs, inputs.length),
    (input, { inspect }) => inspectOne(input, output, inspect),
    (input, error) => output.failure(input, error));
  return worstExit(statuses);
}

/** The glTF extensions that compress or pack geometry. */
const COMPRESSION = /^(KHR_draco_mesh_compression|(KHR|EXT)_meshopt_compression|KHR_mesh_quantization)$/;

/** Reads one model; the function it returns prints the result. */
async function inspectOne(input, output, inspect) {
  const start = performance.now();
  const { bytes, resources } = await readModelFile(input);
  const { warnings, perNode, ...facts } = await inspect(bytes, { resources });
  const report = {
    ...facts,
    sizeBytes: bytes.length,
    // Vertices that repeat the place of another one: the two sides of a seam in normals or texture coordinates.
    seamVertices: facts.vertices - facts.weldedVertices,
    compression: facts.format === 'drc' ? [facts.variant] : facts.extensionsUsed.filter((name) => COMPRESSION.test(name)),
    perNode,
    warnings,
  };
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
        if (typeof value[0] !== 'object') {
          lines.push(`${indent}${name}: ${value.length > 0 ? value.join(', ') : 'none'}`);
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
