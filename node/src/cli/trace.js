// SPDX-License-Identifier: MIT
// quadmark trace: whose copy is this?
import { QuadmarkError } from '../error.js';
import { decodeImage, keyFingerprint, parseKey } from '../index_node.js';
import { createRecipients } from '../recipients.js';
import { exitOfVerdict, worstExit } from './exit.js';
import { displayName, readModelFile } from './files.js';
import { expandGlobs } from './glob.js';
import { readKey } from './keys.js';
import { millisSince, painted } from './output.js';
import { forEachInput, jobCount } from './pool.js';
import { readRegistry } from './registry_file.js';

export async function traceCommand(files, options, output) {
  let inputs, key, entries, warnings;
  try {
    inputs = expandGlobs(files);
    if ([options.key, options.registry, ...inputs].filter((name) => name === '-').length > 1 || options.registry === '-') {
      throw new QuadmarkError('bad_option', 'standard input can be read only once, and is no registry');
    }
    key = await readKey(options);
    ({ entries, warnings } = await entriesOf(options, key));
    output.expect(inputs.length);
  } catch (error) {
    return output.failure(null, error);
  }
  // One model after the other, each with as many comparisons at once as there are jobs.
  const lanes = jobCount(options.jobs, Infinity);
  const statuses = await forEachInput(
    inputs, 1,
    (input, { extract }) => traceOne(input, { key, entries, warnings }, createRecipients({ extract, parseKey, decodeImage }, lanes), output),
    (input, error) => output.failure(input, error),
    { threads: lanes > 1 });
  return worstExit(statuses);
}

async function entriesOf({ registry, salt }, key) {
  const all = readRegistry(registry).entries;
  const fingerprint = await keyFingerprint(key);
  const ours = all.filter((entry) => entry.key === fingerprint);
  if (ours.length === 0) throw new QuadmarkError('bad_key', `${registry}: none of ${all.length} entries is of this key`);
  const entries = salt === undefined ? ours : ours.filter((entry) => (entry.salt ?? '') === salt);
  if (entries.length === 0) throw new QuadmarkError('bad_option', `${registry}: no entry has the salt ${JSON.stringify(salt)}`);
  const others = all.length - ours.length;
  return { entries, warnings: others > 0 ? [`${others} of ${all.length} entries are of other keys and were left out`] : [] };
}

async function traceOne(input, { key, entries, warnings }, { trace }, output) {
  const start = performance.now();
  const { bytes, resources } = await readModelFile(input);
  const onProgress = output.progressOf(input);
  const result = await trace(bytes, {
    key, resources, candidates: entries.map(({ recipient, id, image, salt }) => ({ recipient, id, image, salt })),
    options: { onCandidate: onProgress && (({ done, candidates }) => onProgress({ stage: `candidate ${done} of ${candidates}`, done: done / candidates })) },
  });
  const copies = entries.filter(({ recipient }) => recipient === result.recipient)
    .map(({ model, output: copy, time }) => ({ model, output: copy, time }));
  const millis = millisSince(start);
  return () => {
    output.result({ input, ...result, copies, warnings, millis }, describe(input, result, copies));
    return exitOfVerdict(result.verdict);
  };
}

const percent = (probability) => probability.toPrecision(2);

function describe(input, { verdict, recipient, id, falsePositive, method, trials, candidates }, copies) {
  const name = displayName(input);
  if (verdict === 'match') {
    return [
      `${name}: ${painted(process.stdout, 'good', recipient)}`,
      `  probability of naming this one wrongly: at most ${percent(falsePositive)}, with ${trials} candidates`,
      `  ${method === 'read' ? 'the mark was read' : 'the mark was too faint to be read and was compared with each candidate\'s'}${id === null ? '' : `, ID ${id}`}`,
      ...copies.map(({ model, output, time }) => `  copy of ${model}, written to ${output} on ${time}`),
      ...candidates.slice(1).map((other) => `  but also ${other.recipient}: ${percent(other.corrected)}`),
    ];
  }
  if (verdict === 'none') {
    const why = id === null ? 'no mark of this key' : `the mark of this key with the ID ${id}, which nobody in the registry has`;
    return [`${name}: ${painted(process.stdout, 'bad', 'nobody')} (${why}; ${trials} candidates)`];
  }
  return [
    `${name}: ${painted(process.stdout, 'doubtful', 'inconclusive')} (${trials} candidates)`,
    ...candidates.map((other) => `  perhaps ${other.recipient}: probability by chance at most ${percent(other.corrected)}`),
  ];
}
