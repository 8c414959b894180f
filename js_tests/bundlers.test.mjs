// SPDX-License-Identifier: MIT
// The installed tarball through the bundlers, and with none, in a real Chromium: on a page and in a module worker.
import assert from 'node:assert/strict';
import { createReadStream, existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { before, test } from 'node:test';
import { promisify } from 'node:util';
import { build as esbuild } from 'esbuild';
import { build as vite } from 'vite';
import webpack from 'webpack';
import { noChromium, openChromium } from './support/chromium.mjs';
import { repository, run, temporaryFolder } from './support/files.mjs';
import { sculpture } from './support/marks.mjs';
import { installedPackage } from './support/packed.mjs';

const POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; img-src data:";
const TYPES = { '.js': 'text/javascript', '.wasm': 'application/wasm', '.html': 'text/html' };
const EXPECTED = ['match 0000000000c0ffee', 'match 0000000000c0ffee'];

// `prepare` is what a bundler that knows no new URL() for assets needs.
const SOURCES = (prepare = '') => ({
  'round_trip.js': `
    import { createKey, embed, extract${prepare ? ', load' : ''} } from 'quadmark';
    ${prepare}
    export async function roundTrip() {
      const key = await createKey();
      const { bytes } = await embed(await (await fetch('/in.glb')).arrayBuffer(), { key, id: 'C0FFEE' });
      const { verdict, id } = await extract(bytes, { key });
      return verdict + ' ' + id;
    }`,
  'worker.js': "import { roundTrip } from './round_trip.js'; roundTrip().then(postMessage, (error) => postMessage(String(error)));",
  'main.js': `
    import { roundTrip } from './round_trip.js';
    const inWorker = new Promise((resolve, reject) => {
      const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
      worker.onmessage = ({ data }) => resolve(data);
      worker.onerror = (event) => reject(new Error(event.message));
    });
    Promise.all([roundTrip(), inWorker]).then((results) => { globalThis.results = results; }, (error) => { globalThis.results = [String(error)]; });`,
});

let app;
before(async (t) => {
  // Files of this suite live as long as its process.
  ({ app } = await installedPackage({ after: (action) => process.on('exit', action) }));
  writeFileSync(join(app, 'in.glb'), await sculpture('glb'));
}, { timeout: 120000 });

function write(folder, files) {
  mkdirSync(folder, { recursive: true });
  for (const [name, text] of Object.entries(files)) writeFileSync(join(folder, name), text);
}

/** What the page of a folder says about both round trips. */
async function resultsOf(t, folder, html) {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://localhost');
    const path = pathname === '/in.glb' ? join(app, 'in.glb') : join(folder, pathname);
    response.setHeader('content-security-policy', POLICY);
    if (pathname === '/') return response.setHeader('content-type', 'text/html').end(html);
    if (!existsSync(path) || !statSync(path).isFile()) return response.writeHead(404).end();
    response.setHeader('content-type', TYPES[extname(path)] ?? 'application/octet-stream');
    return createReadStream(path).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => server.close());
  const page = await (await openChromium(t)).newPage();
  const problems = [];
  page.on('console', (message) => { if (message.type() === 'error') problems.push(message.text()); });
  page.on('pageerror', (error) => problems.push(String(error)));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction(() => globalThis.results !== undefined, null, { timeout: 60000 }).catch((error) => problems.push(error.message));
  assert.deepEqual(problems, []);
  return page.evaluate(() => globalThis.results);
}

const page = (script) => `<!doctype html><title>x</title><link rel="icon" href="data:,">${script}`;
const browser = { skip: noChromium, timeout: 180000 };

test('Vite', browser, async (t) => {
  const root = join(app, 'vite');
  write(root, { ...SOURCES(), 'index.html': page('<script type="module" src="./main.js"></script>') });
  await vite({ root, configFile: false, logLevel: 'error', worker: { format: 'es' } });
  const dist = join(root, 'dist');
  assert.deepEqual(await resultsOf(t, dist, readFileSync(join(dist, 'index.html'))), EXPECTED);
});

test('webpack', browser, async (t) => {
  const context = join(app, 'webpack');
  write(context, SOURCES());
  const stats = await promisify(webpack)({ context, mode: 'production', entry: './main.js', output: { path: join(context, 'dist') } });
  assert.equal(stats.hasErrors(), false, stats.toString({ all: false, errors: true }));
  assert.deepEqual(stats.toJson({ all: false, warnings: true }).warnings.map(({ message }) => message).filter((message) => !/size limit|code splitting/.test(message)), []);
  assert.deepEqual(await resultsOf(t, join(context, 'dist'), page('<script src="/main.js"></script>')), EXPECTED);
});

test('esbuild, with the wasm as a file', browser, async (t) => {
  const folder = join(app, 'esbuild');
  write(folder, SOURCES("import wasm from 'quadmark/quadmark.wasm'; load({ wasm });"));
  await esbuild({
    absWorkingDir: folder, entryPoints: ['main.js', 'worker.js'], bundle: true, format: 'esm', splitting: true, outdir: 'dist', publicPath: '/',
    minify: true, loader: { '.wasm': 'file' }, logLevel: 'error',
  });
  assert.deepEqual(await resultsOf(t, join(folder, 'dist'), page('<script type="module" src="/main.js"></script>')), EXPECTED);
});

test('a script tag without any bundler', browser, async (t) => {
  const map = join(app, 'plain');
  const files = Object.fromEntries(Object.entries(SOURCES()).map(([name, text]) => [name, text.replace("'quadmark'", "'/node_modules/quadmark/src/index.js'")]));
  write(map, files);
  for (const tag of ['<script type="module" src="/plain/main.js"></script>', '<script src="/plain/classic.js"></script>']) {
    writeFileSync(join(map, 'classic.js'), "import('/plain/main.js');");
    assert.deepEqual(await resultsOf(t, app, page(tag)), EXPECTED, tag);
  }
});

test('what is not used is not bundled', async () => {
  const bundled = async (name, source) => {
    const root = join(app, 'shaken');
    write(root, { [`${name}.js`]: source });
    const { output } = await vite({
      root, configFile: false, logLevel: 'error', build: { write: false, modulePreload: false, rollupOptions: { input: join(root, `${name}.js`) } },
    });
    return output.filter(({ type }) => type === 'chunk').map(({ code }) => code);
  };
  const error = await bundled('error', "import { QuadmarkError } from 'quadmark'; console.log(QuadmarkError);");
  assert.ok(error.join('').length < 1000, `${error.join('').length} bytes for the error class`);
  const registry = await bundled('registry', "import { parseRegistry } from 'quadmark/recipients'; console.log(parseRegistry);");
  assert.doesNotMatch(registry.join(''), /WebAssembly|INVALID_CLOSING_QUOTE/, 'neither the module nor the reader of CSV');
  const product = await bundled('product', "import { embed } from 'quadmark'; console.log(embed);");
  assert.match(product.join(''), /WebAssembly/);
  assert.doesNotMatch(product.join(''), /local-noise|quadmark_lab/, 'nothing of the laboratory');
  const transform = await bundled('transform', "import { quadmark } from 'quadmark/gltf-transform'; console.log(quadmark);");
  assert.doesNotMatch(transform.join(''), /listTextures|property-graph/, 'nothing of glTF-Transform');
});

test('publint and attw find nothing', { timeout: 120000 }, async (t) => {
  const bin = (name) => join(repository, 'node_modules/.bin', name);
  const node = join(repository, 'node');
  const lint = await run(bin('publint'), ['run', node, '--strict'], {});
  assert.equal(lint.status, 0, `${lint.stdout}${lint.stderr}`);
  assert.match(lint.stdout.toString(), /All good/);
  // The wasm files are no modules, and CommonJS gets the package by import().
  const wasm = readdirSync(join(node, 'dist')).filter((name) => name.endsWith('.wasm')).map((name) => `./${name}`);
  const folder = temporaryFolder(t);
  const attw = await run(bin('attw'), ['--pack', node, '--profile', 'esm-only', '--format', 'json', '--exclude-entrypoints', ...wasm], { cwd: folder });
  assert.equal(attw.status, 0, `${attw.stdout}${attw.stderr}`);
});
