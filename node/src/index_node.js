// SPDX-License-Identifier: MIT
// Entry for Node (threads included): the wasm is read from the file beside the glue.
import { readFile } from 'node:fs/promises';
import factory from '../dist/quadmark.js';
import { createApi } from './api.js';
import { Loader } from './load.js';
import { createRecipients } from './recipients.js';

export { ERROR_EXIT_STATUS, QuadmarkError } from './error.js';

const loader = new Loader(factory, () => readFile(new URL('../dist/quadmark.wasm', import.meta.url)));
const dracoLoader = new Loader(async (options) => (await import('../dist/quadmark_draco.js')).default(options),
  () => readFile(new URL('../dist/quadmark_draco.wasm', import.meta.url)));

const api = createApi(loader, dracoLoader);

export const {
  embed, extract, inspect, externalUris, createKey, parseKey, decodeImage, encodeImage, version, load, unload, memoryBytes,
} = api;
export const { recipientId, keyFingerprint, trace } = createRecipients(api);
