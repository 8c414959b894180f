// SPDX-License-Identifier: MIT
/**
 * Keys from passphrases.
 *
 * @module quadmark/passphrase
 */
import type { RobustKey } from './index.js';

/** Parameters of scrypt, RFC 7914; dkLen: bytes wanted. */
export interface ScryptParameters { N: number; r: number; p: number; dkLen: number; }

/** The parameters that keys from passphrases are made with. */
export const SCRYPT: Readonly<ScryptParameters>;
/** Characters a passphrase needs at least. */
export const LEAST_PASSPHRASE: 12;

/**
 * The key that a passphrase stands for: the same passphrase and owner always give the same one. Fails with `bad_key` when it
 * is too short.
 * @param request  owner: public; part of the salt
 * @param scrypt   of the platform or a library
 */
export function keyFromPassphrase(
  request: { passphrase: string; owner?: string },
  scrypt: (password: Uint8Array, salt: Uint8Array, parameters: ScryptParameters) => Promise<Uint8Array>,
): Promise<RobustKey>;
