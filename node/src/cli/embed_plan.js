// SPDX-License-Identifier: MIT
// Where what embed writes goes: the marked models, and the external files of a .gltf.
import { existsSync } from 'node:fs';
import { basename, dirname, extname, join, resolve } from 'node:path';
import { QuadmarkError } from '../error.js';
import { readInput, safeRelativePath } from './files.js';
import { expandGlobs } from './glob.js';

/** [{ input, output, person? }] from IN OUT, from many inputs and --out-dir, or from these and the recipients of each. */
export function planJobs(files, options, people, output) {
  if (options.outDir !== undefined) {
    const inputs = expandGlobs(files);
    if (inputs.includes('-')) throw new QuadmarkError('bad_option', 'standard input has no name to use in --out-dir');
    if (people === null) return inputs.map((input) => ({ input, output: join(options.outDir, basename(input)) }));
    return inputs.flatMap((input) => people.map((person) => ({ input, output: join(options.outDir, person.folder, basename(input)), person })));
  }
  if (files.length !== 2) {
    throw new QuadmarkError('bad_option', `expected IN and OUT, got ${files.length} name${files.length === 1 ? '' : 's'}; for many inputs give --out-dir`);
  }
  const [input, out] = files;
  if (out === '-' && output.json) throw new QuadmarkError('bad_option', 'the model and --json both want standard output');
  checkFormat(input, out);
  return [{ input, output: out }];
}

/** Refuses an output whose name promises another format than the input's, which marking keeps. */
function checkFormat(input, out) {
  const [from, to] = [input, out].map((name) => extname(name).toLowerCase());
  const formats = ['.glb', '.gltf', '.ply'];
  if (from !== to && formats.includes(from) && formats.includes(to)) {
    throw new QuadmarkError('bad_option', `${out}: marking does not convert, the marked ${basename(input)} is a ${from} too`);
  }
}

/**
 * Where the external files of a .gltf go: under their own relative names beside the output. Buffers must be written,
 * images are copied when they are there, so that the output loads.
 */
export async function planBeside(model, out, writer) {
  const plan = { files: [], warnings: [] };
  const uris = [...model.paths.keys()];
  if (out === '-') {
    if (uris.length > 0) {
      throw new QuadmarkError('bad_option', `the glTF has the external buffer ${JSON.stringify(uris[0])}: write it to a file, not to standard output`);
    }
    return plan;
  }
  const claimed = new Set();
  const place = (uri) => join(dirname(out), safeRelativePath(uri));
  for (const uri of uris) {
    const path = place(uri);
    if (claimed.has(path)) continue;  // two spellings of one file
    claimed.add(path);
    plan.files.push({ uri, path: checkBeside(path, uri, model, writer) });
  }
  for (const [uri, image] of model.images) {
    const path = place(uri);
    if (claimed.has(path) || resolve(path) === resolve(image)) continue;
    claimed.add(path);
    if (!existsSync(image)) {
      plan.warnings.push(`image ${JSON.stringify(uri)} is not there and was not copied`);
      continue;
    }
    if (existsSync(path)) {
      // Shared by several models of one run, or from an earlier one: images are never changed, so equal is done.
      if (!(await readInput(path)).equals(await readInput(image))) {
        plan.warnings.push(`image ${JSON.stringify(uri)} was not copied: another file has its name`);
      }
      continue;
    }
    plan.files.push({ uri, path, image });
  }
  return plan;
}

function checkBeside(path, uri, model, writer) {
  if (resolve(path) === resolve(model.paths.get(uri))) {
    throw new QuadmarkError('io', `the marked buffer ${JSON.stringify(uri)} would overwrite the input's: write to another directory`);
  }
  return writer.check(path, model.name, { makesDirectories: true });
}
