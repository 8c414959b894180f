// SPDX-License-Identifier: MIT
// Keys for jobs: from a file, from a passphrase, or new.
import { scryptAsync } from '@noble/hashes/scrypt.js';
import { createKey, parseKey } from 'quadmark';
import { keyFromPassphrase } from 'quadmark/passphrase';
import { attempt, readFile } from './files.js';
import { fingerprint } from './hash.js';

/**
 * Opens { file } | { key } | { owner } (a new one of scheme robust).
 * @return { key, told }: told is what a report may say of it. A key from a passphrase has no fingerprint: it would let
 *         others try passphrases.
 */
export async function openKey({ file, key, owner }) {
  if (file) {
    const bytes = await readFile('key', file);
    const parsed = await attempt('key', parseKey(bytes));
    return { key: parsed, told: { source: 'file', scheme: parsed.scheme, owner: parsed.owner, ...(await fingerprint(file.name, bytes)) } };
  }
  if (key) return { key, told: { source: 'passphrase', scheme: key.scheme, owner: key.owner } };
  const made = await attempt('key', createKey({ owner }));
  return { key: made, told: { source: 'new', scheme: made.scheme, owner: made.owner } };
}

/** { passphrase, owner } -> { key } */
export async function derive({ passphrase, owner }, progress) {
  progress('derive', 0);
  const scrypt = (password, salt, { N, r, p, dkLen }) =>
    scryptAsync(password, salt, { N, r, p, dkLen, onProgress: (done) => progress('derive', done) });
  return { answer: { type: 'result', key: await keyFromPassphrase({ passphrase, owner }, scrypt) } };
}
