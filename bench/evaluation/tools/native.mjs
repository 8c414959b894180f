// SPDX-License-Identifier: MIT
// Marking and reading files with any scheme, by quadmark_evaluate (evaluate.cpp, beside this folder).
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { repository, run } from '../../../js_tests/support/files.mjs';

const program = join(repository, 'build/native/bench/quadmark_evaluate');

/** Reason to do without, or false. */
export const noEvaluate = existsSync(program) ? false : `${program} is not built`;

async function evaluate(...words) {
  const { status, json, stderr } = await run(program, words.map(String));
  if (status !== 0) throw new Error(`quadmark_evaluate ${words.join(' ')}: ${stderr.trim()}`);
  return json[0];
}

/** The row of the marking; where its outcome is "written" the file `out` is. */
export const mark = ({ scheme, settings, payload, seed }, modelPath, out) =>
  evaluate('mark', scheme, settings, payload, modelPath, seed, out);

/** { outcome, ber, unread, claim } of a file. */
export const read = ({ scheme, settings, payload, seed }, file) => evaluate('read', scheme, settings, payload, file, seed);
