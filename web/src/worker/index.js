// SPDX-License-Identifier: MIT
// The working thread: opens files, runs quadmark on them, and answers with plain data.
//   in   { job: 'verify' | 'mark' | 'inspect' | 'unpack' | 'derive', ... }   see the module of the job
//   out  { type: 'progress', stage, done }          any number of times, then one of
//        { type: 'result', ... }                    see the module of the job
//        { type: 'missing', uris }                  external buffers that were not given, as file names
//        { type: 'problem', about, code, message }  about: "model", "key", "reference", "logo" or "page"
import { memoryBytes, unload } from 'quadmark';
import { Problem } from './files.js';
import { derive } from './keys.js';
import { inspectModel, mark } from './mark.js';
import { unpack } from './unpack.js';
import { verify } from './verify.js';

const JOBS = { verify, mark, inspect: inspectModel, unpack, derive };

/** Module memory worth keeping for the next job; it never shrinks by itself. */
const KEEP_BYTES = 256 * 2 ** 20;

self.addEventListener('message', async ({ data }) => {
  let answer, transfer = [];
  try {
    ({ answer, transfer = [] } = await JOBS[data.job](data, (stage, done) => postMessage({ type: 'progress', stage, done })));
  } catch (error) {
    answer = error instanceof Problem
      ? { type: error.type, about: error.about, code: error.code, message: error.message, uris: error.uris }
      : { type: 'problem', about: 'page', code: 'internal', message: String(error?.message ?? error) };
  }
  if (memoryBytes() > KEEP_BYTES) unload();
  postMessage(answer, transfer);
});
