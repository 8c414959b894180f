// SPDX-License-Identifier: MIT
// The other side of pool.js: one call at a time.
import { parentPort } from 'node:worker_threads';
import { embed, extract, inspect } from '../index_node.js';

const CALLS = { embed, extract, inspect };

parentPort.on('message', async ({ name, model, request }) => {
  try {
    parentPort.postMessage({ result: await CALLS[name](model, request) });
  } catch ({ code = 'internal', message }) {
    parentPort.postMessage({ error: { code, message } });
  }
});
