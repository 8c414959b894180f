// SPDX-License-Identifier: MIT
// quadmark-server: the endpoint as an object, and as a program that ends well.
import { createEndpoint } from './app.js';

export { DEFAULTS } from './options.js';

/**
 * Starts the endpoint. Documented in index.d.ts.
 * @return { url, drain, close }
 */
export async function serve(given) {
  const { app, options, admission } = await createEndpoint(given);
  let url;
  try {
    url = await app.listen({ host: options.host, port: options.port });
  } catch (error) {
    await app.close();
    throw error;
  }
  return {
    url,
    async close() {
      // /readyz says 503 and new work is refused until what runs is done; its time limit bounds the wait.
      await admission.drain();
      await app.close();
    },
  };
}

/**
 * Runs the endpoint until SIGTERM or SIGINT, finishes what runs, and returns. A second signal ends the process at once.
 * @param onReady  called with the URL once requests are answered
 */
export async function serveUntilSignal(given, onReady) {
  const endpoint = await serve(given);
  const signals = ['SIGTERM', 'SIGINT'];
  const signal = new Promise((resolve) => {
    let seen = 0;
    const receive = (name) => {
      if (++seen > 1) process.exit(name === 'SIGINT' ? 130 : 143);
      resolve();
    };
    for (const name of signals) process.on(name, receive);
  });
  onReady(endpoint.url);
  await signal;
  await endpoint.close();
}
