// SPDX-License-Identifier: MIT
// The models of the evaluation. Names with a colon are generated (bench/models.h), others are files that may be absent.
import { existsSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { repository } from './paths.mjs';

const folder = resolve(process.env.QUADMARK_MODELS ?? join(repository, '../shared/models'));

export const isGenerated = (name) => name.includes(':');

/** As the worker takes it. */
export const modelPath = (name) => (isGenerated(name) ? name : join(folder, name));

export const isPresent = (name) => isGenerated(name) || existsSync(modelPath(name));

/** Why a model that is not there was not measured. */
export const absence = (name) => `${name} was not there: set QUADMARK_MODELS to the folder of the real models`;

/** What a quick run takes instead of every other model. */
export const QUICK_MODELS = ['sculpture:8000:1', 'part:6500:1'];
