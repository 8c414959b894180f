// SPDX-License-Identifier: MIT
// The endpoint as a fastify instance: routes, limits, errors and logs. Listening and signals are serve.js's.
import { randomUUID } from 'node:crypto';
import swagger from '@fastify/swagger';
import underPressure from '@fastify/under-pressure';
import Fastify, { LogController } from 'fastify';
import { version } from 'quadmark';
import { answerEmbed, chooseForm } from './answer.js';
import { readBody, registerBodies } from './body.js';
import { busy, HttpError, toAnswer } from './errors.js';
import { KeyDirectory } from './keys.js';
import { Admission, checkDeclaredSize, limitLife } from './limits.js';
import { createMetrics } from './metrics.js';
import { registerOperation } from './operation.js';
import { complete } from './options.js';
import { Pool } from './pool.js';
import { routeOptions } from './schemas.js';

// A mean over seconds: what it tells is a machine that cannot keep up, not one busy moment.
const MAX_EVENT_LOOP_DELAY_MS = 2000;
const PRESSURE_SAMPLE_MS = 5000;
const HEADERS_TIMEOUT_MS = 10_000;
const REQUEST_ID = /^[A-Za-z0-9._-]{1,64}$/;

/** Requests that never became one: fastify's answer to them has another shape. */
function answerBrokenRequest(error, socket) {
  if (error.code === 'ECONNRESET' || !socket.writable) return socket.destroy();
  const answers = {
    ERR_HTTP_REQUEST_TIMEOUT: ['408 Request Timeout', 'aborted', 'the request did not arrive in time'],
    HPE_HEADER_OVERFLOW: ['431 Request Header Fields Too Large', 'too_large', 'the headers are too large'],
  };
  const [status, code, message] = answers[error.code] ?? ['400 Bad Request', 'bad_option', 'this is no HTTP request'];
  const body = JSON.stringify({ error: { code, message } });
  return socket.end(`HTTP/1.1 ${status}\r\nConnection: close\r\nContent-Type: application/json\r\nContent-Length: ${body.length}\r\n\r\n${body}`);
}

/** One line per answer, by names that we wrote: no query, header, file name or message can bring in what a client sent. */
function logAnswer(request, reply) {
  const { operation } = request.routeOptions.config;
  request.log.info({
    method: request.method, route: request.routeOptions.url ?? null, operation, status: reply.statusCode,
    code: request.failureCode, bytes: request.bytesRead, millis: Math.round(reply.elapsedTime),
  }, 'answered');
}

/** A finding of the schema validator, in the words of the library's own refusals. */
function describeInvalid({ instancePath, keyword, params, message }) {
  if (keyword === 'additionalProperties') return `unknown option ${JSON.stringify(params.additionalProperty)}`;
  const name = instancePath.slice(1);
  return `${name}: ${message}${params.allowedValues ? ` ${params.allowedValues.join(', ')}` : ''}`;
}

function createFastify({ logger, bodyLimit, timeLimit }) {
  return Fastify({
    logger: logger === true ? { level: 'info', base: { pid: process.pid } } : logger,
    logController: new LogController({ disableRequestLogging: true }),
    requestIdHeader: false,
    genReqId: ({ headers }) => (REQUEST_ID.test(headers['x-request-id'] ?? '') ? headers['x-request-id'] : randomUUID()),
    bodyLimit,
    // Backstop for what is not one of our two calls; these have a limit of their own, from the headers on.
    requestTimeout: timeLimit * 1000 + HEADERS_TIMEOUT_MS,
    http: { headersTimeout: HEADERS_TIMEOUT_MS, connectionsCheckingInterval: 1000 },
    clientErrorHandler: answerBrokenRequest,
    // Types are checked, not guessed, but a URL holds nothing but text.
    schemaErrorFormatter: (errors) => new HttpError(400, 'bad_option', describeInvalid(errors[0])),
    ajv: { customOptions: { removeAdditional: false, coerceTypes: true, useDefaults: false, allErrors: false } },
  });
}

/**
 * Makes the endpoint; nothing listens yet.
 * @param given  options as in index.d.ts; fails with `bad_option` or `io`
 * @return { app, options, admission }
 */
export async function createEndpoint(given) {
  const options = complete(given);
  const { bodyLimit, timeLimit } = options;
  const keys = new KeyDirectory(options.keys);
  const admission = new Admission(options.threads + options.queue);
  const pool = await Pool.create(options.threads);
  const metrics = createMetrics(pool, admission);
  const app = createFastify(options);
  app.addHook('onClose', () => pool.close());

  app.decorateRequest('life', null);
  app.decorateRequest('bytesRead', 0);
  app.decorateRequest('failureCode', null);
  registerBodies(app, bodyLimit);
  await app.register(swagger, {
    openapi: {
      openapi: '3.1.0',
      info: { title: 'quadmark', version: await version(), description: 'Marks 3D models and reads their watermarks.', license: { name: 'MIT' } },
      tags: [{ name: 'marks' }, { name: 'operation' }],
    },
    transform: ({ schema, url, route }) => ({ schema: { ...schema, ...route.config?.document }, url }),
  });
  app.addHook('onRequest', async (request, reply) => {
    reply.headers({ 'x-request-id': request.id, 'cache-control': 'no-store', 'x-content-type-options': 'nosniff' });
  });
  await app.register(underPressure, {
    maxEventLoopDelay: MAX_EVENT_LOOP_DELAY_MS,
    sampleInterval: PRESSURE_SAMPLE_MS,
    maxRssBytes: options.maxRssBytes,
    pressureHandler: async (request) => {
      if (request.routeOptions.config.operation) throw busy('the server has too much to do');
    },
  });

  app.addHook('onRequest', async (request, reply) => {
    const { operation } = request.routeOptions.config;
    if (!operation) return;
    // Pages must not use a visitor's endpoint behind his back, by another name of this machine least of all.
    if (request.headers.origin !== undefined) throw new HttpError(403, 'forbidden', 'this endpoint does not serve web pages');
    checkDeclaredSize(request, bodyLimit);
    reply.raw.once('close', admission.enter());
    request.life = limitLife(reply, timeLimit);
  });
  app.addHook('onResponse', async (request, reply) => {
    metrics.answered(request.routeOptions.url ?? 'none', reply.statusCode, reply.elapsedTime / 1000);
    logAnswer(request, reply);
  });
  app.setErrorHandler((error, request, reply) => {
    const { status, code, message, headers, bug } = toAnswer(error, bodyLimit);
    if (bug) request.log.error({ stack: error.stack }, 'a failure of the server');
    request.failureCode = code;
    metrics.failed(request.routeOptions.url ?? 'none', code);
    if (status === 499) logAnswer(request, reply.code(status));  // no answer, so no hook will do it
    return reply.code(status).headers(headers).type('application/json').send(JSON.stringify({ error: { code, message } }));
  });
  app.setNotFoundHandler((request, reply) => {
    request.failureCode = 'not_found';
    return reply.code(404).type('application/json')
      .send(JSON.stringify({ error: { code: 'not_found', message: 'there is nothing here; GET /openapi.json lists what there is' } }));
  });

  /** Reads a request and runs it in a thread: { body, reply of the thread, millis }. */
  const work = async (operation, request) => {
    const { life } = request;
    const headerKey = request.headers['quadmark-key'];
    if (!request.isMultipart()) await keys.get(headerKey);  // refused before the body is read
    const body = await readBody(request, operation, bodyLimit, life);
    request.bytesRead = body.bytes;
    const given = body.fields ?? request.query;
    if (body.fields) {
      if (Object.keys(request.query).length > 0) throw new HttpError(400, 'bad_option', 'multipart: options are fields, not in the URL');
      const validate = request.getValidationFunction('querystring');
      if (!validate(given)) throw new HttpError(400, 'bad_option', describeInvalid(validate.errors[0]));
    }
    if (body.keyId !== undefined && headerKey !== undefined) {
      throw new HttpError(400, 'bad_option', 'the key id is given twice, in the header and in the form');
    }
    const key = await keys.get(body.keyId ?? headerKey);
    life.signal.throwIfAborted();
    const { id, text, expectId, expectText, ...rest } = given;
    const mark = Object.fromEntries(Object.entries({ id, text, expectId, expectText }).filter(([, value]) => value !== undefined));
    const start = performance.now();
    const result = await pool.run(operation, body.model,
      { key, ...mark, ...body.files, resources: { ...body.resources }, options: { ...rest } }, life.signal);
    const millis = Math.round((performance.now() - start) * 10) / 10;
    metrics.worked(operation, millis / 1000);
    return { ...result, report: { command: operation, ...result.report, millis } };
  };

  app.post('/v1/embed', routeOptions('embed'), async (request, reply) => {
    const form = chooseForm(request.headers.accept);
    const marked = await work('embed', request);
    if (form === 'bytes' && Object.keys(marked.resources).length > 0) {
      throw new HttpError(406, 'bad_option', 'the mark is in external buffers: accept application/json or multipart/form-data to get them');
    }
    const { type, body } = answerEmbed(form, marked, marked.report);
    return reply.type(type).send(body);
  });
  app.post('/v1/extract', routeOptions('extract'), async (request, reply) => {
    const { report } = await work('extract', request);
    metrics.verdict(report.verdict);
    return reply.type('application/json').send(JSON.stringify(report));
  });

  registerOperation(app, { metrics, admission });
  await app.ready();
  return { app, options, admission };
}
