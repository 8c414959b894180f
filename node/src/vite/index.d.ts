// SPDX-License-Identifier: MIT
/**
 * A plugin that marks the models of a Vite build.
 *
 * @module quadmark/vite
 */
import type { Plugin } from 'vite';
import type { ImageInput, KeyInput } from '../index.js';

/** Options of the plugin. */
export interface QuadmarkViteOptions {
  /** Path of the key file, relative to the project's root; default: the environment's QUADMARK_KEY_FILE. */
  keyFile?: string;
  /** Or the key itself. */
  key?: KeyInput;
  /** What to embed: exactly one of these three. A function gets the model's path relative to the root, with slashes. */
  id?: string | bigint | ((file: string) => string | bigint);
  /** 1 to 64 bytes of UTF-8. */
  text?: string | ((file: string) => string);
  /** A picture: the path of a PNG, relative to the root, or its bytes. */
  image?: string | Uint8Array;
  /** Globs of the models to mark, relative to the root. Default: all .glb, .gltf and .ply. */
  include?: readonly string[];
  /** Globs of models to leave as they are. Default: none. */
  exclude?: readonly string[];
  /** Mark in the development server too. Default: false, it serves models as they are. */
  dev?: boolean;
  /** What a model that is too small or too coarse for a mark does to the build. Default: "fail". */
  unmarkable?: 'fail' | 'warn';
  /** Where marked models are kept, relative to the root. Default: `quadmark` in Vite's cacheDir, node_modules/.vite/quadmark. */
  cacheDir?: string;
  /** Default "standard". */
  strength?: 'invisible' | 'standard' | 'strong';
  /** Default: the strength's own. */
  maxError?: number;
  /** Default: the strength's own. */
  maxSlide?: number;
  /** Name of the asset; reading takes the same one. Default: empty. */
  salt?: string | ((file: string) => string);
}

/** What applies where an option is not given. */
export const QUADMARK_DEFAULTS: Readonly<{
  include: readonly string[]; exclude: readonly string[]; dev: false; unmarkable: 'fail'; strength: 'standard'; salt: '';
}>;

/**
 * Marks the models of a build: those that modules import (`import url from './chair.glb?url'`, without `?url` too, and
 * `new URL('./chair.glb', import.meta.url)`), and those of the public folder, with the buffers of a .gltf beside them. For
 * models that only workers import, list it under `worker.plugins` too. Marked models are cached by their content, the
 * options, the version and the key's fingerprint; one line per model says what was done.
 */
export function quadmark(options: QuadmarkViteOptions): Plugin[];
