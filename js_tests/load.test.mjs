// SPDX-License-Identifier: MIT
// The loader: when it instantiates, from what, in which environments, and what happens after a crash.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { join } from 'node:path';
import { test } from 'node:test';
import { Worker } from 'node:worker_threads';
import factory from '../node/dist/quadmark.js';
import { createApi } from '../node/src/api.js';
import { needsDraco } from '../node/src/draco.js';
import { Loader } from '../node/src/load.js';
import { generate } from 'quadmark/lab';
import { drc } from './support/draco.mjs';
import { repository, run, temporaryFolder } from './support/files.mjs';

const wasmUrl = new URL('../node/dist/quadmark.wasm', import.meta.url);
const dracoUrl = new URL('../node/dist/quadmark_draco.wasm', import.meta.url);
const wasmBytes = await readFile(wasmUrl);
const fromFile = () => new Loader(factory, () => readFile(wasmUrl));

test('importing instantiates nothing; the first call does, once', async () => {
  const quadmark = await import('quadmark');
  assert.equal(quadmark.memoryBytes(), 0);
  let reads = 0;
  const loader = new Loader(factory, () => { ++reads; return readFile(wasmUrl); });
  const versions = await Promise.all([1, 2, 3].map(() => loader.call((api) => api.version())));
  assert.equal(new Set(versions).size, 1);
  assert.equal(reads, 1);
  assert.ok(loader.memoryBytes > 0);
  loader.unload();
  assert.equal(loader.memoryBytes, 0);
  await loader.call((api) => api.version());
  assert.equal(reads, 1, 'compiled once');
});

test('the wasm may be given as bytes, module, response or URL', async (t) => {
  const server = createServer((request, response) => {
    if (request.url === '/absent.wasm') {
      response.writeHead(404).end('no');
      return;
    }
    // Once with the right MIME type, which streams, and once without, which falls back.
    response.setHeader('content-type', request.url === '/typed.wasm' ? 'application/wasm' : 'text/plain');
    response.end(wasmBytes);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => server.close());
  const origin = `http://127.0.0.1:${server.address().port}`;
  const sources = {
    Buffer: wasmBytes,
    ArrayBuffer: new Uint8Array(wasmBytes).buffer,
    module: await WebAssembly.compile(wasmBytes),
    promise: readFile(wasmUrl),
    response: new Response(wasmBytes, { headers: { 'content-type': 'application/wasm' } }),
    'typed URL': new URL(`${origin}/typed.wasm`),
    'untyped URL': `${origin}/plain.wasm`,
  };
  for (const [name, wasm] of Object.entries(sources)) {
    const api = createApi(new Loader(factory, () => assert.fail('the default was used')));
    await api.load({ wasm });
    assert.match(await api.version(), /^\d+\.\d+\.\d+$/, name);
  }
  const failing = { 'not found': `${origin}/absent.wasm`, 'no wasm': new Uint8Array(8), 'nothing of use': 7, unreachable: 'http://127.0.0.1:1/x.wasm' };
  for (const [name, wasm] of Object.entries(failing)) {
    const api = createApi(new Loader(factory, () => readFile(wasmUrl)));
    await assert.rejects(api.load({ wasm }), { name: 'QuadmarkError', code: 'io' }, name);
    assert.match(await api.version(), /^\d/, `${name}: a later call tries again`);
  }
});

test('the module with Draco is fetched with the first model that needs it', async () => {
  const reads = { plain: 0, draco: 0 };
  const loader = new Loader(factory, () => { ++reads.plain; return readFile(wasmUrl); });
  const draco = new Loader(async (options) => (await import('../node/dist/quadmark_draco.js')).default(options),
    () => { ++reads.draco; return readFile(dracoUrl); });
  const api = createApi(loader, draco);
  const { bytes } = await generate({ name: 'icosphere', vertices: 200, format: 'glb' });
  assert.equal((await api.inspect(bytes)).format, 'glb');
  await api.externalUris(drc);
  assert.deepEqual(reads, { plain: 1, draco: 0 });
  const [first, second] = await Promise.all([api.inspect(drc), api.inspect(drc)]);
  assert.deepEqual(first, second);
  assert.equal(first.format, 'drc');
  assert.equal(first.faces, 8);
  assert.deepEqual(reads, { plain: 1, draco: 1 });
  assert.equal(api.memoryBytes(), loader.memoryBytes + draco.memoryBytes);
  api.unload();
  assert.equal(api.memoryBytes(), 0);
  // What escapes hide is refused by name, not misread.
  await assert.rejects(createApi(loader).inspect(drc), { code: 'unsupported_file', message: /no Draco decoder/ });

  const elsewhere = createApi(fromFile(), new Loader(async (options) => (await import('../node/dist/quadmark_draco.js')).default(options),
    () => assert.fail('the default was used')));
  await elsewhere.load({ dracoWasm: readFile(dracoUrl) });
  assert.equal((await elsewhere.inspect(drc)).vertices, 9);
});

test('models that need Draco are told by their bytes', () => {
  const text = (json) => Buffer.from(JSON.stringify(json));
  const glb = (json) => {
    const bytes = Buffer.concat([Buffer.alloc(20), text(json), Buffer.from('KHR_draco_mesh_compression"KHR_draco_mesh_compression"')]);
    bytes.write('glTF', 'latin1');
    bytes.writeUInt32LE(text(json).length, 12);
    return bytes;
  };
  const named = { extensionsUsed: ['KHR_draco_mesh_compression'] };
  for (const model of [drc, text(named), glb(named), Buffer.from(`\ufeff ${text(named)}`)]) assert.equal(needsDraco(model), true);
  for (const model of [text({}), glb({}), Buffer.from('ply\n"KHR_draco_mesh_compression"'), new Uint8Array(), Buffer.from('glTF')]) {
    assert.equal(needsDraco(model), false);
  }
});

test('a trap kills the instance once; the next call has a new one', async () => {
  const loader = fromFile();
  const api = createApi(loader);
  await api.load();
  await assert.rejects(
    loader.call(() => { throw new WebAssembly.RuntimeError('unreachable'); }),
    { code: 'internal', message: /unreachable.*bug in quadmark/ });
  assert.equal(loader.memoryBytes, 0);
  assert.match(await api.version(), /^\d/);
  // Emscripten throws a bare number for an uncaught C++ exception.
  await assert.rejects(loader.call(() => { throw 5246024; }), { code: 'internal', message: /5246024/ });
  assert.match(await api.version(), /^\d/);
});

test('a failed allocation is "too_large" and the module recovers', async () => {
  // A memory that cannot grow stands in for a machine that is full.
  const grow = WebAssembly.Memory.prototype.grow;
  const loader = fromFile();
  const api = createApi(loader);
  await api.load();
  WebAssembly.Memory.prototype.grow = () => { throw new RangeError('WebAssembly.Memory.grow(): Maximum memory size exceeded'); };
  try {
    await assert.rejects(api.inspect(new Uint8Array(200 << 20)), { code: 'too_large', message: /out of memory/ });
  } finally {
    WebAssembly.Memory.prototype.grow = grow;
  }
  assert.equal(loader.memoryBytes, 0);
  assert.match(await api.version(), /^\d/);
});

test('it works in a worker thread', async (t) => {
  const file = join(temporaryFolder(t), 'worker.mjs');
  writeFileSync(file, `
    import { parentPort } from 'node:worker_threads';
    import { createKey, embed, extract } from ${JSON.stringify(import.meta.resolve('quadmark'))};
    import { generate } from ${JSON.stringify(import.meta.resolve('quadmark/lab'))};
    const key = await createKey({ id: true });
    const { bytes } = await embed((await generate({ name: 'sculpture', vertices: 4000 })).bytes, { key, id: 'abcdef' });
    parentPort.postMessage((await extract(bytes, { key })).id);
  `);
  const worker = new Worker(file);
  const id = await new Promise((resolve, reject) => worker.once('message', resolve).once('error', reject));
  assert.equal(id, '0000000000abcdef');
});

test('it runs where code generation from strings is forbidden', async () => {
  const script = `
    import { createKey, inspect } from 'quadmark';
    import { generate, attackKinds } from 'quadmark/lab';
    let forbidden = false;
    try { new Function('return 1')(); } catch { forbidden = true; }
    const { bytes } = await generate({ name: 'icosphere', vertices: 200 });
    await createKey({ width: 24, height: 24 });
    console.log(JSON.stringify({ forbidden, kinds: (await attackKinds()).length, format: (await inspect(bytes)).format }));`;
  const { status, stdout, stderr } = await run(
    process.execPath, ['--disallow-code-generation-from-strings', '--input-type=module', '-e', script], { cwd: repository });
  assert.equal(status, 0, stderr);
  const result = JSON.parse(stdout);
  assert.equal(result.forbidden, true);
  assert.equal(result.format, 'ply');
  assert.ok(result.kinds >= 9);
});

test('the entry for browsers exports what the entry for Node does', async () => {
  const [web, node] = await Promise.all([import('../node/src/index.js'), import('../node/src/index_node.js')]);
  assert.deepEqual(Object.keys(web), Object.keys(node));
  const [webLab, nodeLab] = await Promise.all([import('../node/src/lab.js'), import('../node/src/lab_node.js')]);
  assert.deepEqual(Object.keys(webLab), Object.keys(nodeLab));
  await web.load({ wasm: wasmBytes });
  assert.equal(await web.version(), await node.version());
});
