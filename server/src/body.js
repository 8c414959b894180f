// SPDX-License-Identifier: MIT
// Reading a request: { model, resources, files, fields, keyId } of a raw or a multipart body, never more of it than the
// limit, and no longer than its signal says.
import { PassThrough } from 'node:stream';
import multipart from '@fastify/multipart';
import { HttpError, tooLarge } from './errors.js';
import { FILES, MODEL_TYPES } from './schemas.js';

const FIELD_BYTES = 4096;
const MAX_RESOURCES = 256;
const MAX_FIELDS = 32;

/** A promise that rejects when `signal` aborts; never settles otherwise. */
function rejectionOf(signal) {
  return new Promise((_, reject) => {
    if (signal.aborted) reject(signal.reason);
    else signal.addEventListener('abort', () => reject(signal.reason), { once: true });
  });
}

/** All bytes of a stream, in a buffer of their own that a thread can take over. */
async function readAll(stream, signal) {
  const chunks = [];
  let length = 0;
  for await (const chunk of stream) {
    signal.throwIfAborted();
    chunks.push(chunk);
    length += chunk.length;
  }
  const bytes = new Uint8Array(length);
  let at = 0;
  for (const chunk of chunks) {
    bytes.set(chunk, at);
    at += chunk.length;
  }
  return bytes;
}

/** Teaches the server the media types. Bodies are left unread: the handler reads them under its limits. */
export function registerBodies(app, bodyLimit) {
  app.removeAllContentTypeParsers();
  app.addContentTypeParser(MODEL_TYPES, (request, payload, done) => done(null, payload));
  app.register(multipart, {
    preservePath: true,  // a resource's file name is its URI, folders and all
    throwFileSizeLimit: true,
    limits: {
      fileSize: bodyLimit, fieldSize: FIELD_BYTES, fields: MAX_FIELDS,
      files: MAX_RESOURCES + 2, parts: MAX_RESOURCES + MAX_FIELDS + 2, headerPairs: 32,
    },
  });
}

/** Through a stream of its own: ending the connection's would take the answer along. */
async function readRaw(request, signal) {
  return { model: await readAll(request.raw.pipe(new PassThrough()), signal), resources: {}, files: {}, fields: null, keyId: undefined };
}

async function readMultipart(request, operation, signal) {
  const found = { model: undefined, resources: Object.create(null), files: {}, fields: Object.create(null), keyId: undefined };
  const twice = (name) => new HttpError(400, 'bad_option', `multipart: ${name} is given twice`);
  for await (const part of request.parts()) {
    const name = part.fieldname;
    if (part.type !== 'file') {
      if (part.valueTruncated) throw new HttpError(400, 'bad_option', `multipart: the field ${name} is longer than ${FIELD_BYTES} bytes`);
      if (name === 'key') {
        if (found.keyId !== undefined) throw twice('key');
        found.keyId = part.value;
      } else {
        if (name in found.fields) throw twice(name);
        found.fields[name] = part.value;
      }
      continue;
    }
    const bytes = await readAll(part.file, signal);
    if (name === 'model') {
      if (found.model) throw twice('model');
      found.model = bytes;
    } else if (name === 'resource') {
      if (part.filename in found.resources) throw twice(`resource ${JSON.stringify(part.filename)}`);
      found.resources[part.filename] = bytes;
    } else if (FILES[operation].includes(name)) {
      if (found.files[name]) throw twice(name);
      found.files[name] = bytes;
    } else {
      const names = ['model', 'resource', ...FILES[operation]].join(', ');
      throw new HttpError(400, 'bad_option', `multipart: unexpected file ${JSON.stringify(name)}, expected ${names}`);
    }
  }
  if (!found.model) throw new HttpError(400, 'bad_option', 'multipart: the file model is missing');
  return found;
}

/** What the form's parser says of a malformed one is no more than text. */
function inOurTerms(error) {
  if (error.code !== undefined) throw error;
  throw new HttpError(400, 'bad_option', `the form is malformed: ${error.message.replace(/^Multipart: /, '')}`);
}

/**
 * Reads the body of `request`.
 * @param operation  embed or extract
 * @param limit      bytes, whatever Content-Length says
 * @param abort      the request's AbortController: aborted by the time limit, by a client that left, or here by the size
 * @return { model, resources, files, fields, keyId, bytes }; fields is null for a raw body
 */
export async function readBody(request, operation, limit, abort) {
  const { raw } = request;
  const { signal } = abort;
  let bytes = 0;
  const count = (chunk) => {
    bytes += chunk.length;
    if (bytes > limit) abort.abort(tooLarge(limit));
  };
  raw.on('data', count);
  const reading = request.isMultipart() ? readMultipart(request, operation, signal).catch(inOurTerms) : readRaw(request, signal);
  const stopped = rejectionOf(signal);
  for (const racing of [reading, stopped]) racing.catch(() => {});  // the one that loses
  try {
    return { ...(await Promise.race([reading, stopped])), bytes };
  } catch (error) {
    // The rest flows into nothing, so that the client gets to read the answer.
    raw.unpipe();
    raw.resume();
    throw error;
  } finally {
    raw.off('data', count);
  }
}
