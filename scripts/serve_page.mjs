// SPDX-License-Identifier: MIT
// Serves the built page on this machine only, with the content security policy it is made for.
//   node scripts/serve_page.mjs [--port N] [--root FOLDER]
import { createReadStream, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, resolve, sep } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

export const CONTENT_SECURITY_POLICY = [
  "default-src 'none'", "script-src 'self' 'wasm-unsafe-eval'", "worker-src 'self'", "connect-src 'self'",
  "style-src 'self'", "img-src 'self' blob: data:", "font-src 'self'", "manifest-src 'self'", "base-uri 'none'",
  "form-action 'none'", "frame-ancestors 'none'",
].join('; ');

const TYPES = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8',
  '.wasm': 'application/wasm', '.json': 'application/json', '.svg': 'image/svg+xml', '.png': 'image/png',
  '.glb': 'model/gltf-binary', '.ico': 'image/x-icon', '.webmanifest': 'application/manifest+json',
};

/** Path of the file a request means, or null. */
function fileFor(root, url) {
  let path;
  try {
    path = decodeURIComponent(new URL(url, 'http://localhost').pathname);
  } catch {
    return null;
  }
  const file = resolve(join(root, path.endsWith('/') ? `${path}index.html` : path));
  if (!file.startsWith(root + sep) || path.includes('\0')) return null;
  try {
    return statSync(file).isFile() ? file : null;
  } catch {
    return null;
  }
}

/** Starts a server of `root` on 127.0.0.1; port 0 takes a free one. Resolves to { server, url }. */
export function servePage({ root, port = 0 }) {
  const folder = resolve(root);
  const server = createServer((request, response) => {
    response.setHeader('content-security-policy', CONTENT_SECURITY_POLICY);
    response.setHeader('x-content-type-options', 'nosniff');
    response.setHeader('referrer-policy', 'no-referrer');
    response.setHeader('cache-control', 'no-cache');
    const file = request.method === 'GET' || request.method === 'HEAD' ? fileFor(folder, request.url) : null;
    if (file === null) {
      response.writeHead(404, { 'content-type': 'text/plain' }).end('not found\n');
      return;
    }
    response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream' });
    if (request.method === 'HEAD') response.end();
    else createReadStream(file).on('error', () => response.destroy()).pipe(response);
  });
  return new Promise((resolveServer, reject) => {
    server.once('error', reject);
    server.listen(port, '127.0.0.1', () => resolveServer({ server, url: `http://127.0.0.1:${server.address().port}/` }));
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const { values } = parseArgs({ options: { port: { type: 'string', default: '8765' }, root: { type: 'string' } } });
  const root = values.root ?? fileURLToPath(new URL('../web/dist', import.meta.url));
  try {
    statSync(join(root, 'index.html'));
    const { url } = await servePage({ root, port: Number(values.port) }).catch((error) => {
      if (error.code !== 'EADDRINUSE') throw error;
      return servePage({ root });
    });
    console.log(`The page is served at ${url} (Ctrl-C ends it)`);
  } catch (error) {
    console.error(error.code === 'ENOENT' ? `${root} has no index.html: build the page first (npm run build --workspace web)` : error.message);
    process.exitCode = 1;
  }
}
