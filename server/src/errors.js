// SPDX-License-Identifier: MIT
// What a failure looks like over HTTP: { error: { code, message } } with the library's codes, and the status of each.
import { QuadmarkError } from 'quadmark';

/** HTTP status by the library's error codes; a test compares the list with the library's own. */
export const STATUS_OF_CODE = Object.freeze({
  bad_file: 422,
  unsupported_file: 415,
  bad_mesh: 422,
  bad_option: 400,
  bad_key: 422,
  bad_image: 422,
  capacity: 422,
  unsupported_version: 422,
  too_large: 413,
  io: 500,
  aborted: 408,
  internal: 500,
});

/** Codes that only this endpoint has: what a library call cannot run into. */
export const SERVER_CODES = Object.freeze({ busy: 503, not_found: 404, forbidden: 403 });

/** A failure with a status of its own, where its code's would mislead, and headers that go with it. */
export class HttpError extends QuadmarkError {
  constructor(status, code, message, headers = {}) {
    super(code, message);
    this.status = status;
    this.headers = headers;
  }
}

const RETRY_AFTER_SECONDS = 1;

/** Too much to do at present, or shutting down: try again. */
export const busy = (message, headers = {}) =>
  new HttpError(503, 'busy', message, { 'retry-after': String(RETRY_AFTER_SECONDS), ...headers });

export const tooLarge = (limit) =>
  new HttpError(413, 'too_large', `the request is larger than the limit of ${limit} bytes`);

const MEDIA_TYPE = 'unsupported media type: send model/gltf-binary, model/gltf+json, model/ply, application/octet-stream or multipart/form-data';

/** Errors of the framework in our terms; null for what must be a bug. */
function ofFramework(error, bodyLimit) {
  if (error.validation) return new HttpError(400, 'bad_option', error.message);
  if (error.statusCode === 413) return tooLarge(bodyLimit);
  if (error.statusCode === 415) return new HttpError(415, 'unsupported_file', MEDIA_TYPE);
  if (error.statusCode >= 400 && error.statusCode < 500) return new HttpError(error.statusCode, 'bad_option', error.message);
  return null;
}

/**
 * Any exception as an answer.
 * @return { status, code, message, headers, bug } where bug says that the exception belongs in the log with its stack
 */
export function toAnswer(error, bodyLimit) {
  const known = error instanceof QuadmarkError ? error : ofFramework(error, bodyLimit);
  if (!known) {
    return { status: 500, code: 'internal', message: 'an unexpected failure; the server\'s log has more', headers: {}, bug: true };
  }
  const { code, message, status = STATUS_OF_CODE[code] ?? 500, headers = {} } = known;
  return { status, code, message, headers, bug: code === 'internal' };
}
