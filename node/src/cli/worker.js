// SPDX-License-Identifier: MIT
// The other side of pool.js: one call at a time.
import { parentPort } from 'node:worker_threads';
import { embed, extract, inspect } from '../index_node.js';

const CALLS = { embed, extract, inspect };

const INTERVAL = 50;  // milliseconds between messages of progress

parentPort.on('message', async ({ name, model, request, reports }) => {
  let sent = -Infinity;
  if (reports) {
    request.options.onProgress = (progress) => {
      const now = performance.now();
      if (now - sent < INTERVAL) return;
      sent = now;
      parentPort.postMessage({ progress });
    };
  }
  try {
    parentPort.postMessage({ result: await CALLS[name](model, request) });
  } catch ({ code = 'internal', message }) {
    parentPort.postMessage({ error: { code, message } });
  }
});
