// SPDX-License-Identifier: MIT
// The limits of the HTTP endpoint, each run into: size, time, places, key ids, clients that leave, shutting down.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { request as httpRequest } from 'node:http';
import { connect } from 'node:net';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey } from 'quadmark';
import { quadmark, run, temporaryFolder } from './support/files.mjs';
import { sculpture } from './support/marks.mjs';
import { formOf, keyDirectory, metricOf, startServer, until } from './support/server.mjs';

const key = await createKey();
const small = await sculpture('glb', 3000);
// Seconds of work: what is done about it is decided long before it ends.
const large = await sculpture('glb', 400_000);

async function start(t, options) {
  const folder = temporaryFolder(t);
  const server = await startServer(t, keyDirectory(folder, { studio: key }), { bodyLimitMiB: 64, ...options });
  const send = (model, { path = 'embed?id=1', signal, headers } = {}) => fetch(`${server.url}/v1/${path}`, {
    method: 'POST', body: model, signal,
    headers: { 'quadmark-key': 'studio', 'content-type': 'application/octet-stream', ...headers },
  });
  const inside = () => metricOf(server.url, 'quadmark_requests_inside');
  return { ...server, folder, send, inside };
}

async function refused(response, status, code) {
  assert.equal(response.status, status);
  assert.equal((await response.json()).error.code, code);
  return response;
}

test('a body above the limit is refused, declared or not, raw or in parts', async (t) => {
  const { url, send, inside } = await start(t, { bodyLimitMiB: 1 });
  const big = new Uint8Array(3 * 2 ** 20);
  await refused(await send(big), 413, 'too_large');
  const stream = () => new ReadableStream({
    start(controller) {
      for (let i = 0; i < 48; ++i) controller.enqueue(big.subarray(0, 65536));
      controller.close();
    },
  });
  const chunked = (headers) => fetch(`${url}/v1/extract`, { method: 'POST', body: stream(), duplex: 'half', headers });
  await refused(await chunked({ 'quadmark-key': 'studio', 'content-type': 'application/octet-stream' }), 413, 'too_large');
  const form = (fields) => fetch(`${url}/v1/extract`, { method: 'POST', body: formOf({ key: 'studio', ...fields }) });
  await refused(await form({ model: big }), 413, 'too_large');
  // A form whose length is not told: only what arrives is counted.
  const body = Buffer.concat([
    Buffer.from('--b\r\nContent-Disposition: form-data; name="model"; filename="a"\r\n\r\n'), big, Buffer.from('\r\n--b--\r\n')]);
  const untold = await fetch(`${url}/v1/extract`, {
    method: 'POST', duplex: 'half', headers: { 'content-type': 'multipart/form-data; boundary=b' },
    body: new ReadableStream({ start(controller) { controller.enqueue(body); controller.close(); } }),
  });
  await refused(untold, 413, 'too_large');
  const names = Array.from({ length: 400 }, (_, i) => ({ bytes: small.subarray(0, 10), filename: `${i}.bin` }));
  await refused(await form({ model: small, resource: names }), 413, 'too_large');
  await until(async () => (await inside()) === 0, 'all places are free again');
  assert.equal((await send(small)).status, 200);
});

test('at the time limit the work itself ends, and the thread is free', async (t) => {
  const { url, send, logs } = await start(t, { threads: 1, timeLimit: 0.6 });
  assert.equal(await metricOf(url, 'quadmark_threads_ended'), 0);
  const response = await refused(await send(large), 408, 'aborted');
  assert.equal(response.headers.get('connection'), 'close');
  assert.equal(await metricOf(url, 'quadmark_threads_ended'), 1, 'the thread was ended in the middle of its work');
  // The only thread's successor may need longer than the limit to start on a busy machine.
  await until(async () => (await send(small)).status === 200, 'a small model is marked in time');
  assert.ok(logs().includes('"code":"aborted"'));
});

test('a body that does not arrive in time is given up', async (t) => {
  const { url, inside } = await start(t, { timeLimit: 0.5 });
  const { hostname, port } = new URL(url);
  const answer = await new Promise((resolve, reject) => {
    const client = httpRequest({ hostname, port, path: '/v1/extract', method: 'POST',
      headers: { 'quadmark-key': 'studio', 'content-type': 'application/octet-stream', 'content-length': 1000 } }, resolve);
    client.on('error', reject);
    client.write('glTF');
  });
  assert.equal(answer.statusCode, 408);
  answer.destroy();
  await until(async () => (await inside()) === 0, 'its place is free');
});

test('when threads and queue are full, requests are refused before they are read, with Retry-After', async (t) => {
  const { send, inside } = await start(t, { threads: 1, queue: 1 });
  const working = [send(large), send(large)];
  await until(async () => (await inside()) === 2, 'both are inside');
  const response = await refused(await send(small), 503, 'busy');
  assert.match(response.headers.get('retry-after'), /^\d+$/);
  for (const answer of await Promise.all(working)) {
    assert.equal(answer.status, 200);
    await answer.arrayBuffer();
  }
  await until(async () => (await inside()) === 0, 'all places are free again');
  assert.equal((await send(small)).status, 200);
});

test('a client that leaves takes its work along', async (t) => {
  const { url, send, inside, logs } = await start(t, { threads: 1 });
  const client = new AbortController();
  const gone = send(large, { signal: client.signal });
  await until(async () => (await metricOf(url, 'quadmark_pool_working')) === 1, 'a thread is at it');
  client.abort();
  await assert.rejects(gone, { name: 'AbortError' });
  await until(async () => (await inside()) === 0, 'its place is free');
  assert.equal(await metricOf(url, 'quadmark_threads_ended'), 1);
  assert.equal((await send(small)).status, 200);
  await until(() => logs().includes('"status":499'), 'the log says so');
});

test('key ids lead nowhere but into the key directory', async (t) => {
  const { url, folder, send } = await start(t);
  writeFileSync(join(folder, 'outside.json'), JSON.stringify(key));
  const malformed = ['../outside', '..%2foutside', '/etc/passwd', 'studio.json', '.', '..', 'a/b', 'a\\b', '-x', ' ', 'x'.repeat(65), 'studio,studio'];
  for (const id of malformed) {
    await refused(await send(small, { headers: { 'quadmark-key': id } }), 400, 'bad_key');
    const form = await fetch(`${url}/v1/extract`, { method: 'POST', body: formOf({ key: id, model: small }) });
    await refused(form, 400, 'bad_key');
  }
  const nul = await fetch(`${url}/v1/extract`, { method: 'POST', body: formOf({ key: 'studio\0', model: small }) });
  await refused(nul, 400, 'bad_key');
  for (const id of ['outside', 'STUDIO_', 'studi', '__proto__x']) {
    const answer = await send(small, { headers: { 'quadmark-key': id } });
    await refused(answer, id.startsWith('_') ? 400 : 404, 'bad_key');
  }
  const none = await fetch(`${url}/v1/extract`, { method: 'POST', body: small, headers: { 'content-type': 'application/octet-stream' } });
  await refused(none, 400, 'bad_option');
});

test('SIGTERM finishes what runs, says so on /readyz and then ends with status 0', async (t) => {
  const { url, process: child, send, inside, exit } = await start(t, { threads: 1 });
  assert.equal((await fetch(`${url}/readyz`)).status, 200);
  const running = send(large);
  const waiting = send(small);
  await until(async () => (await inside()) === 2, 'both are inside');
  child.kill('SIGTERM');
  await until(async () => (await fetch(`${url}/readyz`)).status === 503, '/readyz says 503');
  assert.deepEqual(await (await fetch(`${url}/readyz`)).json(), { status: 'draining' });
  assert.equal((await fetch(`${url}/healthz`)).status, 200);
  await refused(await send(small), 503, 'busy');
  for (const response of await Promise.all([running, waiting])) {
    assert.equal(response.status, 200);
    assert.ok((await response.arrayBuffer()).byteLength > 0);
  }
  assert.equal(await exit, 0);
  await assert.rejects(fetch(`${url}/healthz`));
});

test('what is no HTTP gets an answer of the same form', async (t) => {
  const { url } = await start(t);
  const { hostname, port } = new URL(url);
  const answer = await new Promise((resolve, reject) => {
    const socket = connect(port, hostname, () => socket.write('PAINT IT BLACK\r\n\r\n'));
    let text = '';
    socket.on('data', (chunk) => { text += chunk; });
    socket.on('end', () => resolve(text));
    socket.on('error', reject);
  });
  assert.match(answer, /^HTTP\/1\.1 400 /);
  assert.equal(JSON.parse(answer.split('\r\n\r\n')[1]).error.code, 'bad_option');
});

test('the command refuses what it cannot do', async (t) => {
  const folder = temporaryFolder(t);
  assert.equal((await quadmark(['serve'])).status, 2);
  const absent = await quadmark(['serve', '--json', '--keys', join(folder, 'absent')]);
  assert.equal(absent.status, 1);
  assert.equal(absent.json[0].error.code, 'io');
  assert.equal((await quadmark(['serve', '--keys', folder, '--threads', '0'])).status, 2);
  // Without the package, the sentence says what to install.
  const source = `import { register } from 'node:module';
    register('data:text/javascript,' + encodeURIComponent(\`export async function resolve(name, context, next) {
      if (name === 'quadmark-server') throw Object.assign(new Error("Cannot find package 'quadmark-server' imported from x"), { code: 'ERR_MODULE_NOT_FOUND' });
      return next(name, context);
    }\`));
    process.argv.splice(1, 0, 'quadmark');
    const { run } = await import(process.env.PROGRAM);
    process.exitCode = await run(process.argv.slice(2));`;
  const without = await run(process.execPath, ['--input-type=module', '-e', source, 'serve', '--keys', folder],
    { env: { PROGRAM: new URL('../node/src/cli/program.js', import.meta.url).href } });
  assert.equal(without.status, 2, without.stderr);
  assert.match(without.stderr, /npm install quadmark-server/);
});
