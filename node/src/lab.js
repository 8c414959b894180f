// SPDX-License-Identifier: MIT
// Entry of quadmark/lab for browsers, workers and bundlers: the literal URL is what makes a bundler ship the wasm.
import factory from '../dist/quadmark_lab.js';
import { createLab } from './lab_api.js';
import { Loader } from './load.js';

const loader = new Loader(factory, () => new URL('../dist/quadmark_lab.wasm', import.meta.url));

export const { attack, generate, attackKinds, load, unload } = createLab(loader);
