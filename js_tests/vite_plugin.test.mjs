// SPDX-License-Identifier: MIT
// quadmark/vite in Vite as a project has it: builds are run by its command line, and what lands in dist/ is read.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey, extract } from 'quadmark';
import { generate } from 'quadmark/lab';
import { quadmark } from 'quadmark/vite';
import { noChromium, openChromium } from './support/chromium.mjs';
import { realModel, repository, run, temporaryFolder } from './support/files.mjs';
import { splitGlb } from './support/gltf.mjs';
import { fixedRobustKey, sculpture } from './support/marks.mjs';

const key = await fixedRobustKey();
const glb = await sculpture('glb', 4000);
const coarse = (await generate({ name: 'icosphere', vertices: 250, format: 'glb' })).bytes;
const { gltf, bin } = splitGlb(glb, 'data.bin');

/** A project with Vite and quadmark in node_modules, and the plugin with `options` (source text). */
function project(t, options, files, environment = {}) {
  const folder = temporaryFolder(t);
  mkdirSync(join(folder, 'node_modules'));
  for (const name of ['vite', 'quadmark']) {
    symlinkSync(name === 'quadmark' ? join(repository, 'node') : join(repository, 'node_modules', name), join(folder, 'node_modules', name));
  }
  const config = `import { quadmark } from 'quadmark/vite';
export default { base: './', plugins: [quadmark({ keyFile: 'key.json', ${options} })], worker: { format: 'es' } };`;
  const all = {
    'package.json': '{ "type": "module" }', 'key.json': JSON.stringify(key), 'vite.config.js': config,
    'index.html': '<!doctype html><title>x</title><script type="module" src="/src/main.js"></script>', ...files,
  };
  for (const [name, content] of Object.entries(all)) {
    mkdirSync(join(folder, name, '..'), { recursive: true });
    writeFileSync(join(folder, name), content);
  }
  const build = async () => {
    const env = { NO_COLOR: '1', FORCE_COLOR: undefined, ...environment };
    const { status, stdout, stderr } = await run(process.execPath, ['node_modules/vite/bin/vite.js', 'build'], { cwd: folder, env });
    return { status, said: `${stdout}${stderr}` };
  };
  const built = async () => {
    const { status, said } = await build();
    assert.equal(status, 0, said);
    return said;
  };
  const assets = () => readdirSync(join(folder, 'dist'), { recursive: true }).filter((name) => /\.(glb|gltf|bin)$/.test(name)).sort();
  const read = (name) => readFileSync(join(folder, name));
  return { folder, build, built, assets, read, idOf: async (name, more = {}) => (await extract(read(join('dist', name)), { key, ...more })).id };
}

const main = `
  import a from './a.glb?url';
  import b from './b.glb';
  const c = new URL('./c.glb', import.meta.url).href; // not "new URL('./d.glb', import.meta.url)"
  const lazy = () => import('./e.glb?url');
  console.log(a, b, c, lazy, 'f.glb', \`\${import.meta.env.BASE_URL}f.glb\`);`;
const models = { 'src/main.js': main, 'src/a.glb': glb, 'src/b.glb': glb, 'src/c.glb': glb, 'src/e.glb': glb, 'public/deep/f.glb': glb };
const nameOf = (path) => path.replace(/^assets\//, '').replace(/-[\w-]{8}\.glb$/, '.glb');

test('models come out of a build marked, however they are imported, and those of the public folder', async (t) => {
  const { built, assets, idOf } = project(t, 'id: (file) => file === "public/deep/f.glb" ? "f" : "abc"', models);
  const said = await built();
  // Equal files are one asset to Vite.
  assert.deepEqual(new Set(assets().map(nameOf)).has('deep/f.glb'), true);
  for (const name of assets()) assert.equal(await idOf(name), (name === 'deep/f.glb' ? 'f' : 'abc').padStart(16, '0'), name);
  const lines = said.split('\n').filter((line) => line.startsWith('quadmark: '));
  assert.deepEqual(lines.map((line) => /^quadmark: ([^:]+): (marked|cached)/.exec(line)?.[1]).sort(),
    ['public/deep/f.glb', 'src/a.glb', 'src/b.glb', 'src/c.glb', 'src/e.glb'], 'one line per asset');
  assert.equal(said.includes(key.secret), false);
});

test('a second build takes everything from the cache; another key, option or file does not', async (t) => {
  const { folder, built, assets, read } = project(t, 'id: "abc", strength: process.env.STRENGTH', { ...models, 'src/main.js': 'import a from "./a.glb?url"; console.log(a);' });
  assert.match(await built(), /src\/a\.glb: marked, strength standard, SNR [\d.]+ dB/);
  const first = assets(), bytes = read(join('dist', first[0]));
  const cache = join(folder, 'node_modules/.vite/quadmark');
  assert.ok(existsSync(cache));
  const again = await built();
  assert.match(again, /src\/a\.glb: cached/);
  assert.doesNotMatch(again, /: marked/);
  assert.deepEqual([assets(), read(join('dist', first[0]))], [first, bytes]);

  writeFileSync(join(folder, 'key.json'), JSON.stringify(await createKey()));
  assert.match(await built(), /src\/a\.glb: marked/);
  assert.notDeepEqual(assets(), first, 'another mark has another name');
  writeFileSync(join(folder, 'src/a.glb'), await sculpture('glb', 4500));
  assert.match(await built(), /src\/a\.glb: marked/);
  const stored = readdirSync(cache, { recursive: true }).map(String);
  assert.ok(stored.every((name) => !name.includes('tmp')), stored.join());
  rmSync(join(folder, 'vite.config.js'));
  writeFileSync(join(folder, 'vite.config.mjs'), `import { quadmark } from 'quadmark/vite';
export default { plugins: [quadmark({ keyFile: 'key.json', id: 'abc', strength: 'strong', cacheDir: 'kept' })] };`);
  assert.match(await built(), /src\/a\.glb: marked, strength strong/);
  assert.equal(readdirSync(join(folder, 'kept')).length, 2, 'the imported one and that of the public folder');
});

test('a .gltf in the public folder is marked with its buffer; an imported one is refused', async (t) => {
  const files = { 'src/main.js': '', 'public/m.gltf': gltf, 'public/data.bin': bin };
  const { built, read } = project(t, 'id: "abc"', files);
  await built();
  const { id } = await extract(read('dist/m.gltf'), { key, resources: { 'data.bin': read('dist/data.bin') } });
  assert.equal(id, '0000000000000abc');
  const other = project(t, 'id: "abc"', { 'src/main.js': 'import a from "./m.gltf?url"; console.log(a);', 'src/m.gltf': gltf, 'src/data.bin': bin });
  const { status, said } = await other.build();
  assert.equal(status, 1);
  assert.match(said, /src\/m\.gltf: refers to "data\.bin", which an imported file cannot bring along/);
  const shared = project(t, 'id: (file) => file === "public/m.gltf" ? "1" : "2"', { ...files, 'public/n.gltf': gltf });
  assert.match((await shared.build()).said, /two models share this buffer/);
});

test('a model that only HTML refers to is marked too, with a warning', async (t) => {
  const { built, assets, idOf } = project(t, 'id: "abc"', {
    'index.html': '<!doctype html><title>x</title><link rel="preload" as="fetch" href="./src/a.glb"><script type="module" src="/src/main.js"></script>',
    'src/main.js': '', 'src/a.glb': glb,
  });
  assert.match(await built(), /src\/a\.glb: marked as assets\/a-[\w-]+\.glb, a name made of the unmarked file/);
  assert.equal(await idOf(assets()[0]), '0000000000000abc');
});

test('include, exclude, and what cannot be marked', async (t) => {
  const files = { 'src/main.js': 'import a from "./a.glb?url"; import s from "./small.glb?url"; console.log(a, s);', 'src/a.glb': glb, 'src/small.glb': coarse, 'public/raw.glb': glb };
  const strict = await project(t, 'id: "abc"', files).build();
  assert.equal(strict.status, 1);
  assert.match(strict.said, /src\/small\.glb: /);
  const lenient = project(t, 'id: "abc", unmarkable: "warn", exclude: ["public/**"]', files);
  assert.match(await lenient.built(), /src\/small\.glb: not marked: /);
  assert.deepEqual(lenient.read('dist/raw.glb'), Buffer.from(glb));
  const names = lenient.assets();
  assert.deepEqual(lenient.read(join('dist', names.find((name) => name.includes('small')))), Buffer.from(coarse));
  assert.equal(await lenient.idOf(names.find((name) => /\ba-/.test(name))), '0000000000000abc');
});

test('wrong options are refused with the reason', async (t) => {
  const refused = (options, message) => assert.throws(() => quadmark(options), (error) => error.code === 'bad_option' && message.test(error.message));
  refused({ key }, /exactly one of image, id and text/);
  refused({ key, keyFile: 'x', id: '1' }, /not both/);
  refused({ key, id: '1', includes: [] }, /unknown member "includes"/);
  refused({ key, id: '1', unmarkable: 'ignore' }, /unmarkable/);
  const { build, folder } = project(t, 'id: "1"', { 'src/main.js': '' });
  rmSync(join(folder, 'key.json'));
  assert.match((await build()).said, /cannot read the key key\.json/);
});

/** The development server of a project, as its origin. */
async function serve(t, folder) {
  const child = spawn(process.execPath, ['node_modules/vite/bin/vite.js', '--port', '0', '--host', '127.0.0.1'], { cwd: folder, env: { ...process.env, NO_COLOR: '1' } });
  t.after(() => new Promise((resolve) => { child.on('exit', resolve); child.kill(); }));
  let said = '';
  return new Promise((resolve, reject) => {
    child.on('exit', () => reject(new Error(said)));
    child.stdout.on('data', (chunk) => {
      said += chunk;
      const found = /http:\/\/127\.0\.0\.1:\d+/.exec(said);
      if (found) resolve(found[0]);
    });
  });
}

test('the development server leaves models alone unless asked', { timeout: 120000 }, async (t) => {
  const files = { 'src/main.js': 'import a from "./a.glb?url"; console.log(a);', 'src/a.glb': glb, 'public/f.glb': glb, 'public/m.gltf': gltf, 'public/data.bin': bin };
  const get = async (url) => new Uint8Array(await (await fetch(url)).arrayBuffer());
  const urlIn = async (origin) => /"([^"]*a\.glb[^"]*)"/.exec(await (await fetch(`${origin}/src/a.glb?import&url`)).text())[1];
  const plain = await serve(t, project(t, 'id: "abc"', files).folder);
  assert.deepEqual(await get(`${plain}/f.glb`), glb);
  assert.deepEqual(await get(`${plain}${await urlIn(plain)}`), glb);

  const marked = await serve(t, project(t, 'id: "abc", dev: true', files).folder);
  const imported = await urlIn(marked);
  const module = /\.vite/.test(imported) ? /"([^"]+)"/.exec(await (await fetch(`${marked}${imported}`)).text())?.[1] ?? imported : imported;
  for (const url of [module, '/f.glb']) assert.equal((await extract(await get(`${marked}${url}`), { key })).id, '0000000000000abc', url);
  const [document, buffer] = [await get(`${marked}/m.gltf`), await get(`${marked}/data.bin`)];
  assert.equal((await extract(document, { key, resources: { 'data.bin': buffer } })).id, '0000000000000abc');
});

test('the example\'s page loads its marked models', { skip: noChromium }, async (t) => {
  const duck = realModel(t, 'Duck.glb');
  const model = duck === null ? glb : readFileSync(duck);
  const example = join(repository, 'examples/vite');
  const { folder, built, assets, read } = project(t, '', { 'public/public.glb': model, 'src/model.glb': model, 'src/other.glb': model }, { QUADMARK_KEY_FILE: 'key.json' });
  cpSync(example, folder, { recursive: true });
  await built();
  for (const name of assets()) {
    const salt = nameOf(name);
    assert.equal((await extract(read(join('dist', name)), { key, options: { salt } })).id, '0000000000c0ffee', name);
  }
  const page = await (await openChromium(t)).newPage();
  await page.route('http://vite.test/**', (route) => {
    const path = decodeURIComponent(new URL(route.request().url()).pathname);
    return route.fulfill({ path: join(folder, 'dist', path === '/' ? 'index.html' : path) });
  });
  await page.goto('http://vite.test/');
  await page.waitForFunction(() => document.getElementById('models').textContent !== '');
  const sizes = assets().map((name) => read(join('dist', name)).length).sort();
  assert.deepEqual((await page.textContent('#models')).split(' ').map(Number).sort(), sizes);
});
