// SPDX-License-Identifier: MIT
// JSON schemas of what comes in and goes out. They validate requests and are the OpenAPI document: there is no second
// description. Ranges that the library checks are its own to refuse; here are types, and names that are known at all.
import { ERROR_EXIT_STATUS } from 'quadmark';
import { SERVER_CODES } from './errors.js';
import { KEY_ID_PATTERN } from './keys.js';

const ID = { type: 'string', description: '1 to 16 hexadecimal digits' };
const TEXT = { type: 'string', description: '1 to 64 bytes of UTF-8, keys of scheme robust' };
const SALT = { type: 'string', description: 'name of the asset; reading takes the same one (scheme robust)' };

const options = (properties) => ({ type: 'object', properties, additionalProperties: false });

/** What a request may ask besides files: query parameters with a raw body, fields of a multipart one. */
export const OPTIONS = {
  embed: options({
    id: { ...ID, description: `the 64-bit ID to embed, ${ID.description}` },
    text: { ...TEXT, description: `the text to embed, ${TEXT.description}` },
    strength: {
      type: 'string', enum: ['invisible', 'standard', 'strong'], description: 'how much the mark may change and withstand (scheme robust)',
    },
    maxError: { type: 'number', description: 'cap on every displacement, fraction of the diagonal (scheme robust)' },
    maxSlide: { type: 'number', description: 'cap on its part along the surface (scheme robust)' },
    salt: SALT,
    selfTest: { type: 'boolean', description: 'damage the marked model in six ways and report which it withstands (scheme robust)' },
  }),
  extract: options({
    expectId: { ...ID, description: `is it this ID? ${ID.description} (scheme robust)` },
    expectText: { ...TEXT, description: `is it this text? ${TEXT.description}` },
    salt: SALT,
  }),
};

/** Files of a multipart request besides model and resource. */
export const FILES = { embed: ['image'], extract: ['reference'] };

const bytes = { type: 'string', format: 'binary' };

export const MODEL_TYPES = ['model/gltf-binary', 'model/gltf+json', 'model/ply', 'application/octet-stream'];

const KEY = { type: 'string', pattern: KEY_ID_PATTERN, description: 'id of a key in the server\'s key directory; never part of a URL' };

const headers = {
  type: 'object',
  // Without the pattern: a malformed id is refused in the same words from here and from the field.
  properties: { 'quadmark-key': { type: 'string', description: `${KEY.description}; a multipart request may hold it in the field key instead` } },
};

const error = {
  type: 'object',
  required: ['error'],
  properties: {
    error: {
      type: 'object',
      required: ['code', 'message'],
      properties: {
        code: { type: 'string', enum: [...Object.keys(ERROR_EXIT_STATUS), ...Object.keys(SERVER_CODES)] },
        message: { type: 'string', description: 'one sentence that names the place' },
      },
    },
  },
};

const FAILURES = {
  400: 'an option or the key id is missing, malformed or unknown',
  403: 'the request comes from a web page',
  404: 'no key with this id',
  406: 'none of the accepted media types can hold the answer',
  408: 'stopped at the time limit',
  413: 'larger than the limit, or too large to work on',
  415: 'a media type or a feature of the model that is not supported',
  422: 'the model, the picture or the key cannot be used, or the model cannot hold the payload',
  500: 'a failure of the server',
  503: 'too much to do, or shutting down: try again after Retry-After seconds',
};

const json = (description, schema) => ({ description, content: { 'application/json': { schema } } });

const failures = Object.fromEntries(Object.entries(FAILURES).map(([status, description]) => [status, json(description, error)]));

/** The JSON object that the command line prints, whose members docs/format.md describes. */
const report = (members) => ({
  type: 'object',
  required: ['command', 'scheme', 'warnings', 'millis'],
  properties: {
    command: { type: 'string' },
    scheme: { type: 'string' },
    warnings: { type: 'array', items: { type: 'string' } },
    millis: { type: 'number', description: 'time in a thread, without waiting for one' },
    ...members,
  },
  additionalProperties: true,
});

const marked = {
  model: { type: 'string', contentEncoding: 'base64', description: 'the marked model' },
  resources: { type: 'object', additionalProperties: { type: 'string' }, description: 'base64 of the external buffers that changed, by URI' },
};

const RESPONSES = {
  embed: {
    200: {
      description: 'the marked model; with application/json and multipart/form-data its report too',
      content: {
        ...Object.fromEntries(MODEL_TYPES.map((type) => [type, { schema: bytes }])),
        'application/json': { schema: report(marked) },
        'multipart/form-data': {
          schema: {
            type: 'object',
            properties: { report: { type: 'string', description: 'JSON' }, model: bytes, resource: { type: 'array', items: bytes } },
          },
        },
      },
    },
    ...failures,
  },
  extract: {
    200: json('what was read; no mark is a result, not an error', report({
      verdict: { type: 'string', enum: ['match', 'none', 'inconclusive'] },
      falsePositive: { type: 'number' },
    })),
    ...failures,
  },
};

const SUMMARIES = {
  embed: 'Mark a model',
  extract: 'Read the mark of a model',
};

const DESCRIPTIONS = {
  embed: 'Exactly one of id, text and image says what to embed. With Accept: application/json or multipart/form-data the answer holds the report as well.',
  extract: 'At most one of expectId, expectText and reference says what to compare with.',
};

/**
 * Options of a route for fastify. Only the query is validated by the framework: bodies are read as streams, by readBody(),
 * and answers are sent as they are; both are described in `document` for the OpenAPI document.
 */
export function routeOptions(operation) {
  const files = Object.fromEntries(FILES[operation].map((name) => [name, { ...bytes, description: 'a PNG' }]));
  const form = {
    type: 'object',
    required: ['model'],
    properties: {
      model: { ...bytes, description: 'GLB, glTF or PLY, found by content' },
      key: KEY,
      ...files,
      ...OPTIONS[operation].properties,
      resource: { type: 'array', items: bytes, description: 'files the glTF refers to; the file name is the URI' },
    },
  };
  return {
    schema: { querystring: OPTIONS[operation] },
    config: {
      operation,
      document: {
        operationId: operation,
        summary: SUMMARIES[operation],
        description: DESCRIPTIONS[operation],
        tags: ['marks'],
        headers,
        body: {
          content: {
            ...Object.fromEntries(MODEL_TYPES.map((type) => [type, { schema: bytes }])),
            'multipart/form-data': { schema: form },
          },
        },
        response: RESPONSES[operation],
      },
    },
  };
}
