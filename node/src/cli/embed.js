// SPDX-License-Identifier: MIT
// quadmark embed: marks models and writes them, with the external files of a .gltf beside the output.
import { existsSync } from 'node:fs';
import { basename, dirname, extname, join, resolve } from 'node:path';
import { QuadmarkError } from '../error.js';
import { EXIT, worstExit } from './exit.js';
import { displayName, naming, readInput, readModelFile, safeRelativePath } from './files.js';
import { expandGlobs } from './glob.js';
import { readKey } from './keys.js';
import { millisSince } from './output.js';
import { forEachInput, jobCount } from './pool.js';
import { Writer } from './write.js';

/** [{ input, output }] from IN OUT, or from many inputs and --out-dir. */
function planJobs(files, options, output) {
  if (options.outDir !== undefined) {
    const inputs = expandGlobs(files);
    if (inputs.includes('-')) throw new QuadmarkError('bad_option', 'standard input has no name to use in --out-dir');
    return inputs.map((input) => ({ input, output: join(options.outDir, basename(input)) }));
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

export async function embedCommand(files, options, output) {
  let jobs, writer, request;
  try {
    jobs = planJobs(files, options, output);
    if ([options.image, options.id, options.text].filter((given) => given !== undefined).length !== 1) {
      throw new QuadmarkError('bad_option', 'give exactly one of --image, --id and --text');
    }
    if ([options.key, options.image, ...jobs.map((job) => job.input)].filter((name) => name === '-').length > 1) {
      throw new QuadmarkError('bad_option', 'standard input can be read only once');
    }
    const key = await readKey(options);
    const { id, text, strength, maxError, maxSlide, salt, selfTest } = options;
    request = { key, id, text, options: { strength, maxError, maxSlide, salt, selfTest } };
    if (options.image !== undefined) request.image = await readInput(options.image, 'cannot read the image');
    const names = [options.key, options.image, ...jobs.map((job) => job.input)].filter((name) => name !== undefined);
    writer = new Writer(options, names);
    if (options.outDir !== undefined) writer.makeDirectory(options.outDir);
    output.expect(jobs.length);
  } catch (error) {
    return output.failure(null, error);
  }
  const statuses = await forEachInput(
    jobs, jobCount(options.jobs, jobs.length),
    (job, { embed }) => embedOne(job, options.image, request, writer, output, embed),
    (job, error) => output.failure(job.input, error));
  return worstExit(statuses);
}

/** Marks and writes one model; the function it returns prints the result. */
async function embedOne({ input, output: out }, image, request, writer, output, embed) {
  const start = performance.now();
  // What cannot be written is said before the work, not after it.
  const target = writer.check(out, input);
  const model = await readModelFile(input);
  for (const path of [...model.paths.values(), ...model.images.values()]) writer.protect(path);
  const beside = await planBeside(model, out, writer);
  const { bytes, resources, report } = await naming(image, ['bad_image'], embed(model.bytes, {
    ...request,
    resources: model.resources,
    options: { ...request.options, onProgress: output.progressOf(input) },
  }));
  const files = [];
  for (const { uri, path, image } of beside.files) {
    files.push({ path, bytes: resources[uri] ?? model.resources[uri] ?? (await readInput(image)) });
  }
  for (const { path } of files) writer.makeDirectory(dirname(path));
  writer.writeAll([...files, { path: target, bytes }]);
  const warnings = [...(report.warnings ?? []), ...beside.warnings];
  const millis = millisSince(start);
  return () => {
    output.result(
      { input, output: out, ...report, warnings, millis },
      describe(input, out, report, beside.files),
      out === '-' ? process.stderr : process.stdout);
    return EXIT.done;
  };
}

/**
 * Where the external files of a .gltf go: under their own relative names beside the output. Buffers must be written,
 * images are copied when they are there, so that the output loads.
 */
async function planBeside(model, out, writer) {
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

function describe(input, out, report, beside) {
  const { scheme, cells, capacityBits, payloadBits, repeats, distortion } = report;
  const number = (value, digits) => (typeof value === 'number' ? value.toFixed(digits) : 'infinite');
  const lines = [`${displayName(input)} -> ${displayOutput(out)}`];
  if (report.capacityClass !== undefined) {
    lines.push(`  ${report.payload} at strength ${report.strength}, capacity ${report.capacityClass}`);
  }
  lines.push(`  scheme ${scheme}: ${payloadBits} bits, each repeated ${describeRepeats(repeats)} times, in ${cells} cells (capacity ${capacityBits} bits)`);
  if (distortion) {
    lines.push(`  SNR ${number(distortion.snrDb, 1)} dB, largest displacement ${(distortion.maxRel * 100).toPrecision(2)} % of the diagonal`);
  }
  for (const [name, { read }] of Object.entries(report.selfTest ?? {})) {
    lines.push(`  after ${name}: ${read ? 'read' : 'not read'}`);
  }
  for (const { path } of beside) lines.push(`  with ${path}`);
  return lines;
}

const displayOutput = (name) => (name === '-' ? 'standard output' : name);

function describeRepeats(repeats) {
  if (typeof repeats !== 'object' || repeats === null) return typeof repeats === 'number' ? repeats.toFixed(1) : '?';
  return Object.entries(repeats).map(([name, value]) => `${name} ${typeof value === 'number' ? +value.toFixed(1) : value}`).join(', ');
}
