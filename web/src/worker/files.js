// SPDX-License-Identifier: MIT
// Opening the user's files in the worker, with failures that know which file they are about.
import { QuadmarkError, externalUris } from 'quadmark';
import { baseName, decodedUri, findPart } from '../files/paths.js';

/** A larger file than this cannot be held beside its mesh in the module's 4 GB. */
const MAX_FILE_BYTES = 1.5 * 2 ** 30;

/** A failure that knows which of the user's files it is about. */
export class Problem extends Error {
  type = 'problem';

  constructor(about, code, message) {
    super(message);
    this.about = about;
    this.code = code;
  }
}

/** External buffers of a glTF that were not given, as file names. */
class Missing extends Problem {
  type = 'missing';

  constructor(uris) {
    super('model', 'io', 'external buffers are missing');
    this.uris = uris;
  }
}

export async function readFile(about, file) {
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
export async function attempt(about, promise, { picture = 'reference' } = {}) {
  try {
    return await promise;
  } catch (error) {
    if (!(error instanceof QuadmarkError)) throw error;
    const by = { bad_key: 'key', unsupported_version: 'key', bad_image: picture, io: 'page', internal: 'page' };
    throw new Problem(by[error.code] ?? about, error.code, error.message);
  }
}

/** A model with the buffers it refers to: { bytes, resources: Map of URI to bytes, named: [{ name, bytes }] }. */
export async function openModel(model, parts) {
  const bytes = await readFile('model', model.file);
  const uris = [...new Set(await attempt('model', externalUris(bytes)))];
  const found = uris.map((uri) => [uri, findPart(uri, model.path, parts)]);
  const missing = found.filter(([, part]) => !part).map(([uri]) => decodedUri(uri));
  if (missing.length > 0) throw new Missing(missing);
  const resources = new Map();
  for (const [uri, part] of found) resources.set(uri, await readFile('model', part.file));
  return { bytes, resources, named: found.map(([uri, part]) => ({ name: baseName(part.path), bytes: resources.get(uri) })) };
}
