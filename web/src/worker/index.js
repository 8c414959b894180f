// SPDX-License-Identifier: MIT
// The detector's thread: opens the files, runs quadmark on them, and answers with plain data.
//   in   { model: Item, key: File, reference: File | null, parts: Item[] }
//   out  { type: 'progress', stage, done }          any number of times, then one of
//        { type: 'result', ... }                    see check()
//        { type: 'missing', uris }                  external buffers that were not given, as file names
//        { type: 'problem', about, code, message }  about: "model", "key", "reference" or "page"
import { QuadmarkError, decodeImage, encodeImage, externalUris, extract, load, memoryBytes, parseKey, unload } from 'quadmark';
import { baseName, decodedUri, findPart } from '../files.js';

/** A larger file than this cannot be held beside its mesh in the module's 4 GB. */
const MAX_FILE_BYTES = 1.5 * 2 ** 30;
/** Module memory worth keeping for the next check; it never shrinks by itself. */
const KEEP_BYTES = 256 * 2 ** 20;

/** A failure that knows which of the user's files it is about. */
class Problem extends Error {
  constructor(about, code, message) {
    super(message);
    this.about = about;
    this.code = code;
  }
}

async function readFile(about, file) {
  if (file.size > MAX_FILE_BYTES) {
    throw new Problem(about, 'too_large', `${file.name} has ${(file.size / 2 ** 30).toFixed(1)} GiB, and this page reads files up to 1.5 GiB`);
  }
  try {
    return new Uint8Array(await file.arrayBuffer());
  } catch (error) {
    throw new Problem(about, 'io', `${file.name} could not be read (${error.message}); it may have been moved or changed`);
  }
}

/** Runs one call of quadmark; its failure is about `about`, unless the code says better. */
async function attempt(about, promise) {
  try {
    return await promise;
  } catch (error) {
    if (!(error instanceof QuadmarkError)) throw error;
    const by = { bad_key: 'key', unsupported_version: 'key', bad_image: 'reference', io: 'page', internal: 'page' };
    throw new Problem(by[error.code] ?? about, error.code, error.message);
  }
}

function progress(stage, done) {
  postMessage({ type: 'progress', stage, done });
}

/** The external buffers of a glTF as a Map of URI to bytes, or the names of those that nothing was given for. */
async function openResources(model, bytes, parts) {
  const uris = [...new Set(await attempt('model', externalUris(bytes)))];
  const found = uris.map((uri) => [uri, findPart(uri, model.path, parts)]);
  const missing = found.filter(([, part]) => !part).map(([uri]) => decodedUri(uri));
  const resources = new Map();
  if (missing.length === 0) {
    for (const [uri, part] of found) resources.set(uri, await readFile('model', part.file));
  }
  return { missing, resources };
}

async function check({ model, key, reference, parts }) {
  progress('load', 0);
  await attempt('page', load());
  progress('open', 0.05);
  const keyObject = await attempt('key', parseKey(await readFile('key', key)));
  const expected = reference ? await attempt('reference', decodeImage(await readFile('reference', reference))) : null;
  const bytes = await readFile('model', model.file);
  const { missing, resources } = await openResources(model, bytes, parts);
  if (missing.length > 0) return { type: 'missing', uris: missing };

  const started = performance.now();
  const { verdict, falsePositive, image, id, text, report } = await attempt('model', extract(bytes, {
    key: keyObject,
    reference: expected ?? undefined,
    resources,
    options: { onProgress: ({ stage, done }) => progress(stage, 0.1 + 0.9 * done) },
  }));
  const millis = Math.round(performance.now() - started);
  let average = 0;
  for (const value of image?.confidence ?? []) average += value / image.confidence.length;
  return {
    type: 'result',
    verdict, falsePositive, image, id, text, millis,
    isId: image === null || keyObject.params?.payload === 'id',
    owner: keyObject.owner,
    averageConfidence: average,
    reference: expected && { ...expected, png: await encodeImage(expected) },
    report: { command: 'extract', input: baseName(model.path), ...report, millis },
  };
}

self.addEventListener('message', async ({ data }) => {
  let answer;
  try {
    answer = await check(data);
  } catch (error) {
    answer = error instanceof Problem
      ? { type: 'problem', about: error.about, code: error.code, message: error.message }
      : { type: 'problem', about: 'page', code: 'internal', message: String(error?.message ?? error) };
  }
  if (memoryBytes() > KEEP_BYTES) unload();
  postMessage(answer);
});
