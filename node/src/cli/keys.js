// SPDX-License-Identifier: MIT
// The key of a run: read once from --key or QUADMARK_KEY_FILE, with --set applied.
import { QuadmarkError } from '../error.js';
import { parseKey } from '../index_node.js';
import { naming, readInput } from './files.js';

const PARAMETERS = ['H1', 'L1', 'H2', 'L2', 'lambda', 'tau', 'k', 'keyedCells', 'scrambleOrder'];

/** Refuses names that --set does not know. */
export function checkSettings(settings = {}, extra = []) {
  for (const name of Object.keys(settings)) {
    if (![...PARAMETERS, ...extra].includes(name)) {
      throw new QuadmarkError('bad_option', `--set ${name}: unknown parameter, expected one of ${PARAMETERS.join(', ')}`);
    }
  }
  return settings;
}

export async function readKey(options) {
  if (!options.key) {  // an empty QUADMARK_KEY_FILE is none
    throw new QuadmarkError('bad_option', 'no key: give --key FILE or set QUADMARK_KEY_FILE');
  }
  const settings = checkSettings(options.set);
  const file = await readInput(options.key, 'cannot read the key');
  const key = await naming(options.key, ['bad_key', 'unsupported_version'], parseKey(file));
  if (options.scheme !== undefined && options.scheme !== key.scheme) {
    throw new QuadmarkError('bad_key', `the key is for scheme ${JSON.stringify(key.scheme)}, not ${JSON.stringify(options.scheme)}`);
  }
  if (Object.keys(settings).length === 0) return key;
  if (key.scheme !== 'paper') throw new QuadmarkError('bad_option', `--set does not go with a key of scheme ${key.scheme}`);
  try {
    return await parseKey({ ...key, params: { ...key.params, ...settings } });
  } catch (error) {
    throw error.code === 'bad_key' ? new QuadmarkError('bad_option', `--set: ${error.message}`, { cause: error }) : error;
  }
}
