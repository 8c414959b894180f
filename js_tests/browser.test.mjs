// SPDX-License-Identifier: MIT
// The package in a real browser without any bundler: on a page and in a module worker, under a content security policy
// without unsafe-eval.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { test } from 'node:test';
import { noChromium, openChromium } from './support/chromium.mjs';
import { repository } from './support/files.mjs';
import { logo, sculpture } from './support/marks.mjs';

const POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; img-src data:";
const TYPES = { '.js': 'text/javascript', '.wasm': 'application/wasm', '.html': 'text/html' };

// The same round trip on the page and in the worker; `source` is where the model comes from.
const ROUND_TRIP = `
import { createKey, embed, extract, inspect, memoryBytes } from '/src/index.js';
export async function roundTrip() {
  const before = memoryBytes();
  const model = await (await fetch('/model.glb')).arrayBuffer();
  const image = await (await fetch('/logo.json')).json();
  const key = await createKey({ width: image.width, height: image.height });
  const stages = new Set();
  const { bytes } = await embed(model, { key, image, options: { onProgress: ({ stage }) => stages.add(stage) } });
  const { verdict, image: read } = await extract(bytes, { key });
  const code = await inspect(new Uint8Array(4)).catch((error) => error.code);
  return { before, verdict, bits: Array.from(read.bits), stages: [...stages], code, after: memoryBytes() };
}`;

async function serve(t, { wasmType = 'application/wasm' } = {}) {
  const image = logo();
  const files = {
    '/': ['text/html', '<!doctype html><title>test</title><link rel="icon" href="data:,"><script type="module" src="/page.js"></script>'],
    '/page.js': ['text/javascript', "import { roundTrip } from '/round_trip.js'; globalThis.roundTrip = roundTrip;"],
    '/worker.js': ['text/javascript', "import { roundTrip } from '/round_trip.js'; onmessage = async () => postMessage(await roundTrip());"],
    '/round_trip.js': ['text/javascript', ROUND_TRIP],
    '/model.glb': ['model/gltf-binary', Buffer.from(await sculpture('glb'))],
    '/logo.json': ['application/json', JSON.stringify({ ...image, bits: [...image.bits] })],
  };
  const requests = [];
  const server = createServer((request, response) => {
    requests.push(request.url);
    response.setHeader('content-security-policy', POLICY);
    try {
      const [type, body] = files[request.url] ?? [TYPES[extname(request.url)], readFileSync(join(repository, 'node', request.url))];
      response.setHeader('content-type', type === 'application/wasm' ? wasmType : type);
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => server.close());
  return { url: `http://127.0.0.1:${server.address().port}/`, requests, image };
}

async function openPage(t, url) {
  const context = await openChromium(t);
  const page = await context.newPage();
  const problems = [];
  page.on('console', (message) => { if (message.type() === 'error') problems.push(message.text()); });
  page.on('pageerror', (error) => problems.push(String(error)));
  await page.goto(url);
  await page.waitForFunction(() => globalThis.roundTrip !== undefined);
  return { page, problems };
}

function assertRoundTrip(result, image) {
  assert.equal(result.before, 0, 'importing instantiates nothing');
  assert.ok(result.after > 0);
  assert.equal(result.verdict, 'match');
  assert.deepEqual(result.bits, [...image.bits]);
  assert.ok(result.stages.length >= 2);
  assert.equal(result.code, 'bad_file');
}

test('it works on a page and in a module worker', { skip: noChromium, timeout: 120000 }, async (t) => {
  const { url, requests, image } = await serve(t);
  const { page, problems } = await openPage(t, url);
  assertRoundTrip(await page.evaluate(() => globalThis.roundTrip()), image);
  assertRoundTrip(await page.evaluate(() => new Promise((resolve, reject) => {
    const worker = new Worker('/worker.js', { type: 'module' });
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = (event) => reject(new Error(event.message));
    worker.postMessage(null);
  })), image);
  assert.deepEqual(problems, []);
  assert.equal(requests.filter((path) => path.includes('lab')).length, 0, 'the lab is not loaded');
});

test('a server with the wrong MIME type will do', { skip: noChromium, timeout: 120000 }, async (t) => {
  const { url, image } = await serve(t, { wasmType: 'application/octet-stream' });
  const { page, problems } = await openPage(t, url);
  assertRoundTrip(await page.evaluate(() => globalThis.roundTrip()), image);
  assert.deepEqual(problems, []);
});
