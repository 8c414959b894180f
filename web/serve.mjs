// SPDX-License-Identifier: MIT
// Serves the built page on this machine only, with the content security policy it is made for.
//   node web/serve.mjs [--port N] [--root FOLDER]
import { createReadStream, realpathSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, resolve, sep } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

/** Of the page itself; index.html holds the same, for servers that send no header (a test compares the two). */
export const PAGE_POLICY = [
  "default-src 'none'", "script-src 'self' 'wasm-unsafe-eval'", "worker-src 'self'", "connect-src 'self'",
  "style-src 'self'", "img-src 'self' blob: data:", "base-uri 'none'", "form-action 'none'",
].join('; ');

/** The header may say one thing more, which a meta element may not. */
export const HEADER_POLICY = `${PAGE_POLICY}; frame-ancestors 'none'`;

const TYPES = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8',
  '.wasm': 'application/wasm', '.json': 'application/json', '.svg': 'image/svg+xml', '.png': 'image/png',
  '.glb': 'model/gltf-binary', '.ply': 'application/octet-stream', '.txt': 'text/plain; charset=utf-8',
};

/** { file } that a request path means, or { status } of the refusal. */
function locate(root, url) {
  let path;
  try {
    path = decodeURIComponent(url.split(/[?#]/, 1)[0]);
  } catch {
    return { status: 400 };
  }
  if (!path.startsWith('/') || /[\0\\]/.test(path) || path.split('/').includes('..')) return { status: 400 };
  try {
    // The real path, so that a link inside the folder does not lead out of it.
    const file = realpathSync(join(root, path.endsWith('/') ? `${path}index.html` : path));
    return file.startsWith(root + sep) && statSync(file).isFile() ? { file } : { status: 404 };
  } catch {
    return { status: 404 };
  }
}

const REFUSALS = { 400: 'bad request\n', 404: 'not found\n', 405: 'only GET and HEAD\n' };

function answer(root, request, response) {
  const headers = {
    'content-security-policy': HEADER_POLICY,
    'x-content-type-options': 'nosniff',
    'referrer-policy': 'no-referrer',
    'cache-control': 'no-cache',
  };
  const known = request.method === 'GET' || request.method === 'HEAD';
  const { file, status } = known ? locate(root, request.url) : { status: 405 };
  if (!file) {
    response.writeHead(status, { ...headers, 'content-type': 'text/plain; charset=utf-8', ...(known ? {} : { allow: 'GET, HEAD' }) });
    response.end(REFUSALS[status]);
    return;
  }
  response.writeHead(200, {
    ...headers,
    'content-type': TYPES[extname(file).toLowerCase()] ?? 'application/octet-stream',
    'content-length': statSync(file).size,
  });
  if (request.method === 'HEAD') response.end();
  else createReadStream(file).on('error', () => response.destroy()).pipe(response);
}

/** Starts a server of `root` on 127.0.0.1; port 0 takes a free one. Resolves to { server, url }. */
export function servePage({ root, port = 0 }) {
  const folder = realpathSync(resolve(root));
  const server = createServer((request, response) => answer(folder, request, response));
  return new Promise((resolveServer, reject) => {
    server.once('error', reject);
    server.listen(port, '127.0.0.1', () => resolveServer({ server, url: `http://127.0.0.1:${server.address().port}/` }));
  });
}

async function main() {
  const { values } = parseArgs({ options: { port: { type: 'string', default: '8765' }, root: { type: 'string' } } });
  const port = Number(values.port);
  if (!/^\d+$/.test(values.port) || port > 65535) throw new Error(`--port: expected 0 to 65535, got ${values.port}`);
  const root = values.root ?? fileURLToPath(new URL('./dist', import.meta.url));
  try {
    statSync(join(root, 'index.html'));
  } catch {
    throw new Error(`${root} has no index.html: build the page first (npm run build --workspace web)`);
  }
  const { url } = await servePage({ root, port }).catch((error) => {
    if (error.code !== 'EADDRINUSE') throw error;
    return servePage({ root });  // any free port will do
  });
  console.log(`The page is served at ${url} (Ctrl-C ends it)`);
}

if (process.argv[1] && realpathSync(process.argv[1]) === fileURLToPath(import.meta.url)) {
  main().catch((error) => {
    console.error(`serve: ${error.message}`);
    process.exitCode = 1;
  });
}
