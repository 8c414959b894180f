// SPDX-License-Identifier: MIT
// The models of the evaluation. Names with a colon are generated (bench/models.h), others are files that may be absent.
import { existsSync, readdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { repository } from './paths.mjs';

const folder = resolve(process.env.QUADMARK_MODELS ?? join(repository, '../shared/models'));

export const isGenerated = (name) => name.includes(':');

// A glTF with files beside it has a folder of its own; names are without it, as rows tell them.
const inFolders = existsSync(folder) ? readdirSync(folder, { withFileTypes: true }).filter((entry) => entry.isDirectory()).map(({ name }) => name) : [];

/** As the worker takes it. */
export function modelPath(name) {
  if (isGenerated(name)) return name;
  return ['.', ...inFolders].map((inner) => join(folder, inner, name)).find((path) => existsSync(path)) ?? join(folder, name);
}

export const isPresent = (name) => isGenerated(name) || existsSync(modelPath(name));

/** Whether there is any row of a model: documents tell of rows, wherever they are made. */
export const wasMeasured = ({ rows }, name) => rows.select({ model: name }).length > 0;

export const absence = (name) =>
  `${name} was not measured: it is not in the folder of the real models (QUADMARK_MODELS), or the run ended before it.`;

/** What a quick run takes instead of every other model. */
export const QUICK_MODELS = ['sculpture:8000:1', 'part:6500:1'];
