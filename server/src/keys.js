// SPDX-License-Identifier: MIT
// Keys by id: DIRECTORY/ID.json. Ids have no dots and no separators, so no id leads out of the directory; links inside
// it are followed, since whoever may write there may also write keys (mounted secrets are links).
import { readFile } from 'node:fs/promises';
import { readdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { QuadmarkError } from 'quadmark';
import { HttpError } from './errors.js';

export const KEY_ID_PATTERN = '^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$';
const KEY_ID = new RegExp(KEY_ID_PATTERN);

export class KeyDirectory {
  #directory;

  /** Fails with `io` when the directory cannot be listed. */
  constructor(directory) {
    this.#directory = resolve(directory);
    try {
      readdirSync(this.#directory);
    } catch (cause) {
      throw new QuadmarkError('io', `the key directory ${directory} cannot be read: ${cause.code ?? cause.message}`, { cause });
    }
  }

  /** JSON text of a key. It is read anew for each request: keys may be added and removed while the server runs. */
  async get(id) {
    if (id === undefined) {
      throw new HttpError(400, 'bad_option', 'no key: give its id in the header quadmark-key or the multipart field key');
    }
    if (typeof id !== 'string' || !KEY_ID.test(id)) {
      throw new HttpError(400, 'bad_key', 'the key id is not 1 to 64 letters, digits, - and _');
    }
    try {
      return await readFile(join(this.#directory, `${id}.json`), 'utf8');
    } catch (cause) {
      if (cause.code === 'ENOENT') throw new HttpError(404, 'bad_key', 'there is no key with this id');
      throw new HttpError(500, 'io', 'the key with this id cannot be read');
    }
  }
}
