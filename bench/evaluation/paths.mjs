// SPDX-License-Identifier: MIT
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

export const repository = resolve(dirname(fileURLToPath(import.meta.url)), '../..');

/** The native worker (evaluate.cpp). */
export const workerFile = process.env.QUADMARK_EVALUATE ?? join(repository, 'build/native/bench/quadmark_evaluate');
