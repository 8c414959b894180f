// SPDX-License-Identifier: MIT
// quadmark attack: damages a model by the lab module and writes the result as a new, plain file.
import { extname } from 'node:path';
import { QuadmarkError } from '../error.js';
import { attack } from '../lab_node.js';
import { EXIT } from './exit.js';
import { displayName, readModelFile } from './files.js';
import { millisSince } from './output.js';
import { Writer } from './write.js';

function formatOf(out, given) {
  if (given !== undefined) return given;
  const extension = extname(out).slice(1).toLowerCase();
  if (out === '-' || extension === '') return 'ply';
  if (extension === 'ply' || extension === 'glb') return extension;
  throw new QuadmarkError('bad_option', `${out}: attacked models are written as .ply or .glb`);
}

export async function attackCommand(input, out, options, output) {
  try {
    const start = performance.now();
    if (out === '-' && output.json) throw new QuadmarkError('bad_option', 'the model and --json both want standard output');
    const format = formatOf(out, options.format);
    const writer = new Writer(options, [input]);
    const target = writer.check(out, input);
    const { bytes: model, resources, paths } = await readModelFile(input);
    for (const path of paths.values()) writer.protect(path);
    const { kind, amount, variant, iterations, seed } = options;
    const request = { kind, amount, variant, iterations, seed, format, resources };
    for (const name of Object.keys(request)) if (request[name] === undefined) delete request[name];
    const { bytes, before, after } = await attack(model, request);
    writer.writeAll([{ path: target, bytes }]);
    const parameters = { kind, amount: amount ?? null, variant: variant ?? null, iterations: iterations ?? null, seed };
    const spelled = Object.entries(parameters).filter(([, value]) => value !== null).map(([name, value]) => `${name} ${value}`);
    output.result(
      { input, output: out, format, ...parameters, before, after, warnings: [], millis: millisSince(start) },
      [`${displayName(input)} -> ${out === '-' ? 'standard output' : out}: ${spelled.join(', ')}`,
        `  ${before.vertices} -> ${after.vertices} vertices, ${before.faces} -> ${after.faces} faces`],
      out === '-' ? process.stderr : process.stdout);
    return EXIT.done;
  } catch (error) {
    return output.failure(input, error);
  }
}
