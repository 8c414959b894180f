// SPDX-License-Identifier: MIT
// Types of `quadmark/passphrase`.
import type { RobustKey } from './index.js';

export interface ScryptParameters { N: number; r: number; p: number; dkLen: number; }

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
