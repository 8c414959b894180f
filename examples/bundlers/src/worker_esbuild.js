// SPDX-License-Identifier: MIT
import { load } from 'quadmark';
import wasm from 'quadmark/quadmark.wasm';
import './worker.js';

load({ wasm });
