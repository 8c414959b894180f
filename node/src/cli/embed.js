// SPDX-License-Identifier: MIT
// quadmark embed: marks models and writes them, with the external files of a .gltf beside the output.
import { existsSync } from 'node:fs';
import { dirname } from 'node:path';
import { QuadmarkError } from '../error.js';
import { planBeside, planJobs } from './embed_plan.js';
import { EXIT, worstExit } from './exit.js';
import { displayName, naming, readInput, readModelFile } from './files.js';
import { readKey } from './keys.js';
import { millisSince } from './output.js';
import { forEachInput, jobCount } from './pool.js';
import { checkRecipientOptions, readRecipients } from './recipients.js';
import { sha256 } from './registry_file.js';
import { Writer } from './write.js';

export async function embedCommand(files, options, output) {
  let jobs, writer, request, registry = null;
  try {
    const { image, id: idText, text: textMark, recipients } = options;
    if ([image, idText, textMark, recipients].filter((given) => given !== undefined).length !== 1) {
      throw new QuadmarkError('bad_option', 'give exactly one of --image, --id, --text and --recipients');
    }
    checkRecipientOptions(options);
    // Many inputs are never standard input, IN OUT may be.
    jobs = planJobs(files, options, null, output);
    if ([options.key, image, recipients, ...jobs.map((job) => job.input)].filter((name) => name === '-').length > 1) {
      throw new QuadmarkError('bad_option', 'standard input can be read only once');
    }
    const key = await readKey(options);
    if (recipients !== undefined) {
      const { people, registry: opened } = await readRecipients(recipients, options, key);
      registry = opened;
      jobs = planJobs(files, options, people, output);
    }
    const { id, text, strength, maxError, maxSlide, salt, selfTest } = options;
    request = { key, id, text, options: { strength, maxError, maxSlide, salt, selfTest } };
    if (options.image !== undefined) request.image = await readInput(options.image, 'cannot read the image');
    const names = [options.key, image, recipients, options.registry, ...new Set(jobs.map((job) => job.input))].filter((name) => name !== undefined);
    writer = new Writer(options, names);
    if (options.outDir !== undefined) writer.makeDirectory(options.outDir);
    output.expect(jobs.length);
  } catch (error) {
    registry?.close();
    return output.failure(null, error);
  }
  try {
    const statuses = await forEachInput(
      jobs, jobCount(options.jobs, jobs.length),
      (job, { embed }) => embedOne(job, options.image, request, registry, writer, output, embed),
      (job, error) => output.failure(job.input, error, job.person && { recipient: job.person.recipient }));
    return worstExit(statuses);
  } finally {
    registry?.close();
  }
}

/** Marks and writes one model; the function it returns prints the result. */
async function embedOne({ input, output: out, person }, image, shared, registry, writer, output, embed) {
  const start = performance.now();
  const model = await readModelFile(input);
  const entry = person && { ...pick(person, ['recipient', 'id', 'image']), salt: shared.options.salt, model: input, modelSha256: sha256(model.bytes), output: out };
  if (entry && model.paths.size === 0 && existsSync(out) && registry.has({ ...entry, outputSha256: sha256(await readInput(out)) })) {
    return () => {
      output.result({ input, output: out, ...pick(person, ['recipient', 'id']), alreadyDone: true, warnings: [], millis: millisSince(start) },
        [`${displayName(input)} -> ${displayOutput(out)} for ${person.recipient}: done before`]);
      return EXIT.done;
    };
  }
  // What cannot be written is said before the work, not after it.
  const target = writer.check(out, input, { makesDirectories: person !== undefined });
  const request = person ? { ...shared, ...pick(person, ['id', 'image']) } : shared;
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
  for (const path of [...files.map((file) => file.path), ...(person ? [target] : [])]) writer.makeDirectory(dirname(path));
  if (entry) registry.add({ ...entry, scheme: report.scheme, outputSha256: sha256(bytes), time: new Date().toISOString() });
  writer.writeAll([...files, { path: target, bytes }]);
  const warnings = [...(report.warnings ?? []), ...beside.warnings];
  const millis = millisSince(start);
  return () => {
    output.result(
      { input, output: out, ...(person ? pick(person, ['recipient', 'id']) : {}), ...report, warnings, millis },
      describe(input, out, report, beside.files, person),
      out === '-' ? process.stderr : process.stdout);
    return EXIT.done;
  };
}

function describe(input, out, report, beside, person) {
  const { scheme, cells, capacityBits, payloadBits, repeats, distortion } = report;
  const number = (value, digits) => (typeof value === 'number' ? value.toFixed(digits) : 'infinite');
  const lines = [`${displayName(input)} -> ${displayOutput(out)}${person ? ` for ${person.recipient}` : ''}`];
  if (report.capacityClass !== undefined) {
    lines.push(`  ${report.payload} at strength ${report.strength}, capacity ${report.capacityClass}`);
  }
  lines.push(`  scheme ${scheme}: ${payloadBits} bits, each repeated ${describeRepeats(repeats)} times, in ${cells} cells (capacity ${capacityBits} bits)`);
  if (distortion) {
    lines.push(`  SNR ${number(distortion.snrDb, 1)} dB, largest displacement ${(distortion.maxRel * 100).toPrecision(2)} % of the diagonal`);
  }
  if (report.textureShift) {
    const { uv, texels, place } = report.textureShift;
    const far = texels === null ? `${uv.toPrecision(2)} of its size` : `${texels.toPrecision(2)} texels`;
    lines.push(`  textures slide by ${far} at most (${place}; --max-slide limits it)`);
  }
  for (const [name, { read }] of Object.entries(report.selfTest ?? {})) {
    lines.push(`  after ${name}: ${read ? 'read' : 'not read'}`);
  }
  for (const { path } of beside) lines.push(`  with ${path}`);
  return lines;
}

const pick = (object, names) => Object.fromEntries(names.filter((name) => object[name] !== undefined).map((name) => [name, object[name]]));

const displayOutput = (name) => (name === '-' ? 'standard output' : name);

function describeRepeats(repeats) {
  if (typeof repeats !== 'object' || repeats === null) return typeof repeats === 'number' ? repeats.toFixed(1) : '?';
  return Object.entries(repeats).map(([name, value]) => `${name} ${typeof value === 'number' ? +value.toFixed(1) : value}`).join(', ');
}
