// SPDX-License-Identifier: MIT
// quadmark extract: reads the mark, says what it is worth, writes the pictures asked for.
import { basename, extname, join } from 'node:path';
import { QuadmarkError } from '../error.js';
import { exitOfVerdict, worstExit } from './exit.js';
import { displayName, naming, readInput, readModelFile } from './files.js';
import { expandGlobs } from './glob.js';
import { readKey } from './keys.js';
import { millisSince, painted } from './output.js';
import { forEachInput, jobCount } from './pool.js';
import { Writer } from './write.js';

export async function extractCommand(files, options, output) {
  let inputs, writer, request;
  try {
    inputs = expandGlobs(files);
    if (inputs.length > 1 && (options.imageOut !== undefined || options.confidenceOut !== undefined)) {
      throw new QuadmarkError('bad_option', '--image-out and --confidence-out take one input; for many give --out-dir');
    }
    if (output.json && [options.imageOut, options.confidenceOut].includes('-')) {
      throw new QuadmarkError('bad_option', 'the picture and --json both want standard output');
    }
    if (options.imageOut === '-' && options.confidenceOut === '-') {
      throw new QuadmarkError('bad_option', 'only one of --image-out and --confidence-out can go to standard output');
    }
    const names = [options.key, options.reference, ...inputs].filter((name) => name !== undefined);
    if (names.filter((name) => name === '-').length > 1) {
      throw new QuadmarkError('bad_option', 'standard input can be read only once');
    }
    const key = await readKey(options);
    request = { key, expectId: options.expectId, expectText: options.expectText, options: { salt: options.salt } };
    if (options.reference !== undefined) request.reference = await readInput(options.reference, 'cannot read the reference');
    writer = new Writer(options, names);
    if (options.outDir !== undefined) writer.makeDirectory(options.outDir);
    output.expect(inputs.length);
  } catch (error) {
    return output.failure(null, error);
  }
  const statuses = await forEachInput(
    inputs, jobCount(options.jobs, inputs.length),
    (input, { extract }) => extractOne(input, options, request, writer, output, extract),
    (input, error) => output.failure(input, error));
  return worstExit(statuses);
}

/** [{ path, of: "png" | "confidencePng" }] */
function picturesOf(input, options, writer) {
  const pictures = [];
  const add = (path, of) => pictures.push({ path: writer.check(path, input), of });
  if (options.imageOut !== undefined) add(options.imageOut, 'png');
  if (options.confidenceOut !== undefined) add(options.confidenceOut, 'confidencePng');
  if (options.outDir !== undefined) {
    const stem = input === '-' ? 'stdin' : basename(input, extname(input));
    add(join(options.outDir, `${stem}.mark.png`), 'png');
    add(join(options.outDir, `${stem}.confidence.png`), 'confidencePng');
  }
  return pictures;
}

/** Reads one model and writes its pictures; the function it returns prints the result. */
async function extractOne(input, options, request, writer, output, extract) {
  const start = performance.now();
  const pictures = picturesOf(input, options, writer);
  const { bytes, resources } = await readModelFile(input);
  const result = await naming(options.reference, ['bad_image'], extract(bytes, {
    ...request, resources, options: { ...request.options, onProgress: output.progressOf(input) },
  }));
  const warnings = [...result.report.warnings];
  const found = result.image ? pictures : [];
  if (found.length < pictures.length) warnings.push('no image was found, so none was written');
  writer.writeAll(found.map(({ path, of }) => ({ path, bytes: result.image[of] })));
  const millis = millisSince(start);
  return () => {
    const stream = found.some(({ path }) => path === '-') ? process.stderr : process.stdout;
    output.result({ input, ...result.report, warnings, millis }, describe(input, result, found, stream), stream);
    return exitOfVerdict(result.verdict);
  };
}

const COLOURS = { match: 'good', none: 'bad', inconclusive: 'doubtful' };

const SENTENCES = {
  match: 'the mark of this key is in the model',
  none: 'no mark of this key',
  inconclusive: 'traces that could be chance',
};

function describe(input, { verdict, falsePositive, image, id, text, report }, pictures, stream) {
  const sentence = report.expected?.comparison === 'differs' ? 'a mark of this key, but another one' : SENTENCES[verdict];
  const lines = [
    `${displayName(input)}: ${painted(stream, COLOURS[verdict], verdict)} (${sentence})`,
    `  probability of this without the mark: at most ${falsePositive.toPrecision(2)}`,
  ];
  if (id !== null) lines.push(`  ID ${id}`);
  if (text !== null) lines.push(`  text ${JSON.stringify(text)}`);
  if (image !== null) {
    const erased = image.erased.reduce((sum, value) => sum + value, 0);
    lines.push(`  ${image.width} x ${image.height} bits, ${erased} unread`);
  }
  if (typeof report.ber === 'number') lines.push(`  bit error rate against the reference: ${report.ber.toFixed(4)}`);
  for (const { path } of pictures) if (path !== '-') lines.push(`  wrote ${path}`);
  return lines;
}
