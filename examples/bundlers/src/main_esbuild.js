// SPDX-License-Identifier: MIT
// esbuild does not follow new URL(..., import.meta.url): the wasm is imported as a file, and the package told where it is.
import { load } from 'quadmark';
import wasm from 'quadmark/quadmark.wasm';

load({ wasm });
import('./main.js');
