// SPDX-License-Identifier: MIT
// The other side of pool.js: one call at a time, with a module of its own.
import { workerData } from 'node:worker_threads';
import { embed, extract, load, memoryBytes, QuadmarkError, unload } from 'quadmark';

const { wasm, dracoWasm, keepBytes } = workerData;

const CALLS = {
  async embed(model, request) {
    const { bytes, resources, report } = await embed(model, request);
    return { bytes, resources, report };
  },
  // Everything that the command line prints of it is in the report.
  extract: async (model, request) => ({ report: (await extract(model, request)).report }),
};

export default async function work({ name, model, request }) {
  try {
    await load({ wasm, dracoWasm });
    return { result: await CALLS[name](model, request) };
  } catch (error) {
    const { code, message } = error instanceof QuadmarkError ? error : { code: 'internal', message: String(error?.stack) };
    return { error: { code, message } };
  } finally {
    if (memoryBytes() > keepBytes) unload();
  }
}
