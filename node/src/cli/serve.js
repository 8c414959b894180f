// SPDX-License-Identifier: MIT
// quadmark serve: the HTTP endpoint, which is a package of its own, loaded when asked for.
import { QuadmarkError } from '../error.js';
import { EXIT } from './exit.js';
import { parseNumber, parseWhole } from './values.js';

const MEBI = 2 ** 20;

async function loadServer() {
  try {
    return await import('quadmark-server');
  } catch (cause) {
    if (cause.code !== 'ERR_MODULE_NOT_FOUND' || !cause.message.includes("'quadmark-server'")) throw cause;
    throw new QuadmarkError('bad_option', 'the HTTP endpoint is a package of its own: npm install quadmark-server', { cause });
  }
}

async function serveCommand(options, output) {
  try {
    const { serveUntilSignal } = await loadServer();
    const { host, port, keys, threads, queue, bodyLimit, timeLimit } = options;
    const server = {
      host, port, keys, threads, queue, timeLimit,
      bodyLimit: bodyLimit === undefined ? undefined : bodyLimit * MEBI,
      logger: { level: options.quiet ? 'error' : 'info', stream: process.stderr },
    };
    await serveUntilSignal(server, (url) => output.result({ url }, [`listening on ${url}`]));
    return EXIT.done;
  } catch (error) {
    return output.failure(null, error.code?.startsWith('E') ? new QuadmarkError('io', error.message, { cause: error }) : error);
  }
}

/** Adds the command to the program. */
export function defineServe(define) {
  define('serve', 'answer HTTP requests to mark and read models (needs the package quadmark-server)', serveCommand)
    .requiredOption('--keys <dir>', 'directory of the keys, needed: requests name ID for the key ID.json')
    .option('--host <address>', 'address to bind to', '127.0.0.1')
    .option('--port <number>', 'port; 0 takes a free one', parseWhole, 8080)
    .option('--threads <count>', 'calls worked on at once (default: one per processor)', parseWhole)
    .option('--queue <count>', 'requests that may wait for a thread, more get 503 (default: four per processor)', parseWhole)
    .option('--body-limit <MiB>', 'largest request, more gets 413 (default: 64)', parseWhole)
    .option('--time-limit <seconds>', 'time for a request, then its work is ended with 408 (default: 60)', parseNumber);
}
