// SPDX-License-Identifier: MIT
// Redis: where it is, and the names that our data has there.
import { Redis } from 'ioredis';
import { QuadmarkError } from 'quadmark';

export const DEFAULT_REDIS = 'redis://127.0.0.1:6379';

/** Of the queue of models; reports have one beside it. */
export const DEFAULT_QUEUE = 'quadmark';
export const reportQueue = (queue) => `${queue}-reports`;

/** For messages: without user name and password. */
const withoutLogin = (url) => url.replace(/\/\/[^@/]*@/, '//');

/**
 * Connects; fails with `io` when nothing answers.
 * @param url  redis://, rediss:// or the path of a Unix socket
 */
export async function connect(url = DEFAULT_REDIS) {
  if (!/^(rediss?:\/\/|\/)/.test(url)) {
    throw new QuadmarkError('bad_option', 'redis: expected redis://HOST:PORT, rediss:// or the path of a Unix socket');
  }
  // null, because workers wait for Redis to come back rather than fail.
  const redis = new Redis(url, { maxRetriesPerRequest: null, lazyConnect: true });
  let reason = '';
  redis.on('error', (error) => { reason = error.message || error.code; });  // told below, or by the next command that fails
  try {
    await redis.connect();
  } catch (cause) {
    redis.disconnect();
    throw new QuadmarkError('io', `Redis at ${withoutLogin(url)} cannot be reached: ${reason || cause.message}`, { cause });
  }
  return redis;
}
