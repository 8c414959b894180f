// SPDX-License-Identifier: MIT
// Fingerprints of files for reports. crypto.subtle is missing on pages from plain http servers other than localhost.
import { sha256 } from '@noble/hashes/sha2.js';

const hex = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, '0')).join('');

/** SHA-256 of bytes as 64 hexadecimal digits. */
export async function sha256Hex(bytes) {
  if (!globalThis.crypto?.subtle) return hex(sha256(bytes));
  return hex(new Uint8Array(await crypto.subtle.digest('SHA-256', bytes)));
}

/** { name, bytes, sha256 } of a file, as reports hold it. */
export const fingerprint = async (name, bytes) => ({ name, bytes: bytes.length, sha256: await sha256Hex(bytes) });
