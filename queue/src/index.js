// SPDX-License-Identifier: MIT
// quadmark-queue: marking on many machines. Documented in index.d.ts.
export { connect, DEFAULT_QUEUE, DEFAULT_REDIS } from './connection.js';
export { deadLetters, retryDead, runStatus, status } from './look.js';
export { enqueue, RETRIES } from './produce.js';
export { fromBucket, fromFolder, fromList } from './sources.js';
export { LOCK_SECONDS, startWorker, TIME_LIMIT_SECONDS } from './work.js';
