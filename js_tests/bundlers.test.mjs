// SPDX-License-Identifier: MIT
// The installed tarball through the bundlers as examples/bundlers uses them, and with none, in a real Chromium: on a page and in
// a module worker.
import assert from 'node:assert/strict';
import { cpSync, createReadStream, existsSync, mkdirSync, readFileSync, readdirSync, statSync, symlinkSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { promisify } from 'node:util';
import { build as vite } from 'vite';
import webpack from 'webpack';
import { noChromium, openChromium } from './support/chromium.mjs';
import { repository, run, temporaryFolder } from './support/files.mjs';
import { sculpture } from './support/marks.mjs';
import { installedPackage } from './support/packed.mjs';

const POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; img-src data:";
const TYPES = { '.js': 'text/javascript', '.wasm': 'application/wasm', '.html': 'text/html' };
const EXPECTED = 'match 0000000000c0ffee';

let app;
before(async () => {
  // Files of this suite live as long as its process.
  ({ app } = await installedPackage({ after: (action) => process.on('exit', action) }));
  cpSync(join(repository, 'examples/bundlers'), app, { recursive: true });
  writeFileSync(join(app, 'model.glb'), await sculpture('glb'));
}, { timeout: 120000 });

/** Fails unless the page of a folder reads its mark, in each of the named outputs. */
async function assertReads(t, folder, html, outputs = ['page', 'worker']) {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://localhost');
    const path = join(pathname === '/model.glb' ? app : folder, pathname);
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
  await page.waitForFunction((ids) => ids.every((id) => document.getElementById(id).textContent !== ''), outputs, { timeout: 60000 })
    .catch((error) => problems.push(error.message));
  assert.deepEqual(problems, []);
  for (const id of outputs) assert.equal(await page.textContent(`#${id}`), EXPECTED, id);
}

const html = (name) => readFileSync(join(app, name), 'utf8');
const withScript = (tag) => html('index.html').replace(/<script.*<\/script>/, tag);
const browser = { skip: noChromium, timeout: 180000 };

test('Vite', browser, async (t) => {
  await vite({ root: app, configFile: join(app, 'vite.config.js'), logLevel: 'error', build: { outDir: 'vite' } });
  await assertReads(t, join(app, 'vite'), html('vite/index.html'));
});

test('webpack', browser, async (t) => {
  const { default: config } = await import(pathToFileURL(join(app, 'webpack.config.js')));
  const stats = await promisify(webpack)({ ...config, context: app, output: { path: join(app, 'webpack') } });
  assert.equal(stats.hasErrors(), false, stats.toString({ all: false, errors: true }));
  assert.equal(stats.hasWarnings(), false, stats.toString({ all: false, warnings: true }));
  await assertReads(t, join(app, 'webpack'), withScript('<script src="/main.js"></script>'));
});

test('esbuild, with the wasm as a file', browser, async (t) => {
  symlinkSync(join(repository, 'node_modules/esbuild'), join(app, 'node_modules/esbuild'));
  const { status, stderr } = await run(process.execPath, ['esbuild.mjs'], { cwd: app });
  assert.equal(status, 0, stderr);
  await assertReads(t, join(app, 'dist'), withScript('<script type="module" src="/main.js"></script>'));
});

test('a script tag without any bundler', browser, async (t) => {
  await assertReads(t, app, html('script_tag.html'), ['page']);
  writeFileSync(join(app, 'classic.js'), "import('/script_tag.js');");
  await assertReads(t, app, html('script_tag.html').replace('type="module" src="/script_tag.js"', 'src="/classic.js"'), ['page']);
});

test('what is not used is not bundled', async () => {
  const bundled = async (name, source) => {
    const root = join(app, 'shaken');
    mkdirSync(root, { recursive: true });
    writeFileSync(join(root, `${name}.js`), source);
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
