// SPDX-License-Identifier: MIT
// Keys from passphrases (docs/format.md, section 1): the same passphrase and owner always give the same key.
import { QuadmarkError } from './error.js';

/** Parameters of scrypt: 128 MiB and about half a second per guess. */
export const SCRYPT = Object.freeze({ N: 2 ** 17, r: 8, p: 1, dkLen: 32 });
export const LEAST_PASSPHRASE = 12;

const SALT_PREFIX = 'quadmark/passphrase/v1\0';

/**
 * A key of scheme robust.
 * @param request  { passphrase: text of at least LEAST_PASSPHRASE characters, owner?: text, public, part of the salt }
 * @param scrypt   (password, salt, { N, r, p, dkLen }) => Promise of Uint8Array; the platform's or a library's
 */
export async function keyFromPassphrase({ passphrase, owner = '' }, scrypt) {
  const normal = passphrase.normalize('NFKC');
  if ([...normal].length < LEAST_PASSPHRASE) {
    throw new QuadmarkError('bad_key', `passphrase: at least ${LEAST_PASSPHRASE} characters are needed, ${[...normal].length} were given`);
  }
  const name = owner.normalize('NFKC');
  const encode = (text) => new TextEncoder().encode(text);
  const secret = await scrypt(encode(normal), encode(SALT_PREFIX + name), SCRYPT);
  return { quadmark: 1, scheme: 'robust', secret: btoa(String.fromCharCode(...secret)), owner: name };
}
