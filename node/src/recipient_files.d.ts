// SPDX-License-Identifier: MIT
/**
 * Lists of recipients and registries of marked copies, as text.
 *
 * @module quadmark/recipients
 */
import type { BitImage } from './index.js';

/** One row of a list of recipients. */
export interface ListedRecipient {
  /** Trimmed, NFC, 1 to 256 bytes; in a list only once. */
  recipient: string;
  /** Path of a logo to embed instead of an ID, relative to the list. */
  image?: string;
  /** Name of the folder for the copy instead of one made from the recipient's name. */
  folder?: string;
  /** Line of the list. */
  line: number;
}

/**
 * Reads a list of recipients: CSV with a header line that has the column `recipient` and perhaps `image` and `folder`.
 * Quotes, BOM, CRLF and empty lines are fine, other columns ignored. Fails with `bad_file` naming the line.
 * @param name  of the file, for messages
 */
export function parseRecipients(csv: string, name?: string): ListedRecipient[];

/** One marked copy. */
export interface RegistryEntry {
  recipient: string;
  /** 16 hexadecimal digits; or the picture. */
  id?: string;
  image?: BitImage;
  salt?: string;
  /** Fingerprint of the key: keyFingerprint(). */
  key: string;
  scheme: string;
  /** Name and SHA-256 of the model before marking, and of the copy. */
  model: string;
  modelSha256: string;
  output: string;
  outputSha256: string;
  /** ISO 8601. */
  time: string;
}

/** One line of a registry, with its line end. */
export function registryLine(entry: RegistryEntry): string;

/**
 * Reads a registry. Fails with `bad_file` or `unsupported_version` naming the line.
 * @returns the entries, and the length of the complete lines: behind it is what a run that was killed left of one
 */
export function parseRegistry(text: string, name?: string): { entries: RegistryEntry[]; end: number };
