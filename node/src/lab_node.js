// SPDX-License-Identifier: MIT
// Entry of quadmark/lab for Node (threads included): the wasm is read from the file beside the glue.
import { readFile } from 'node:fs/promises';
import factory from '../dist/quadmark_lab.js';
import { createLab } from './lab_api.js';
import { Loader } from './load.js';

const loader = new Loader(factory, () => readFile(new URL('../dist/quadmark_lab.wasm', import.meta.url)));

export const { attack, generate, attackKinds, load, unload } = createLab(loader);
