// SPDX-License-Identifier: MIT
/**
 * A transform that marks glTF-Transform's documents.
 *
 * @module quadmark/gltf-transform
 */
import type { Transform } from '@gltf-transform/core';
import type { EmbedOptions, ImageInput, KeyInput, Report } from '../index.js';

export interface QuadmarkOptions extends EmbedOptions {
  key: KeyInput;
  /** What to embed: exactly one of these three, as for embed(). */
  image?: ImageInput;
  id?: string | bigint;
  text?: string;
  /** Called with the facts about the mark, after the positions were replaced. */
  onReport?: (report: Report) => void;
}

/** What applies where an option is not given: strength "standard", salt "" (maxError and maxSlide: the strength's own). */
export const QUADMARK_DEFAULTS: Readonly<{ strength: 'standard'; salt: '' }>;

/**
 * A transform that marks a document: `await document.transform(quadmark({ key, id: 'C0FFEE' }))`.
 *
 * Only the values of POSITION accessors change. Accessors keep their identity, count, type and normalization, and whatever
 * shares them sees the mark; normals, other attributes, materials, extensions and buffers stay as they are. Put it last, and
 * after it nothing that moves vertices: quantize() before it is better than after.
 *
 * Fails with QuadmarkError and leaves the document as it was: `unsupported_file` where a POSITION accessor also serves
 * something else (a morph target, an animation), or where a compression extension would remove a mark of scheme `paper`;
 * `bad_key` for keys with scrambleOrder; `capacity`, `bad_mesh` and the rest as embed() does.
 */
export function quadmark(options: QuadmarkOptions): Transform;
