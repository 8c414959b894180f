// SPDX-License-Identifier: MIT
// Keys of a worker: found by their fingerprint, so that neither keys nor their names are ever in Redis.
import { readdir } from 'node:fs/promises';
import { join } from 'node:path';
import { QuadmarkError } from 'quadmark';
import { ioError, readInput } from './files.js';
import { fingerprint } from './identity.js';

/**
 * The key in `directory` with this fingerprint, as JSON text. Fails with `bad_key` when no file there is that key.
 */
export async function findKey(directory, wanted) {
  let names;
  try {
    names = await readdir(directory);
  } catch (cause) {
    throw ioError(`cannot list the keys in ${directory}`, cause);
  }
  for (const name of names.filter((item) => item.endsWith('.json')).sort()) {
    const text = (await readInput(join(directory, name))).toString();
    const found = await fingerprint(text).catch(() => null);  // another kind of file, or a key of a newer version
    if (found === wanted) return text;
  }
  throw new QuadmarkError('bad_key', `no key with the fingerprint ${wanted} among the worker's keys`);
}
