// SPDX-License-Identifier: MIT
// three.js in a real Chromium (WebGL by software): loads, draws, compares and exports models.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { build } from 'vite';
import { openChromium } from './chromium.mjs';
import { repository } from './files.mjs';
import { isGlb } from './gltf.mjs';

const origin = 'http://three.test';
const dracoFolder = join(repository, 'node_modules/three/examples/jsm/libs/draco/gltf');

async function pageScript() {
  const [{ output }] = await build({
    configFile: false,
    logLevel: 'error',
    build: {
      write: false,
      minify: false,
      lib: { entry: join(repository, 'js_tests/support/three_scene.js'), formats: ['es'], fileName: 'scene' },
    },
  });
  return output[0].code;
}

const modelName = (model) => {
  if (isGlb(model)) return 'model.glb';
  return Buffer.from(model).toString('latin1', 0, 3) === 'ply' ? 'model.ply' : 'model.gltf';
};

/**
 * Opens a page with three on it that closes when the test (or `{ after }` of node:test) ends. Models are bytes, with
 * the files that a .gltf refers to as { uri: bytes }. Every call fails with what three reported.
 */
export async function openThree(t) {
  const script = await pageScript();
  const context = await openChromium(t, { webgl: true });
  const page = await context.newPage();
  const files = new Map([
    ['/', { contentType: 'text/html', body: '<!doctype html><script type="module" src="scene.js"></script>' }],
    ['/scene.js', { contentType: 'text/javascript', body: script }],
    ...['draco_wasm_wrapper.js', 'draco_decoder.wasm'].map((name) => [`/draco/${name}`, { body: readFileSync(join(dracoFolder, name)) }]),
  ]);
  const trouble = [];
  page.on('console', (message) => { if (message.type() === 'error') trouble.push(message.text()); });
  page.on('pageerror', (error) => trouble.push(error.message));
  await context.route(`${origin}/**`, (route) => {
    const file = files.get(decodeURIComponent(new URL(route.request().url()).pathname));
    return route.fulfill(file ?? { status: 404 });
  });
  await page.goto(`${origin}/`);
  await page.waitForFunction(() => window.three !== undefined);

  let folders = 0;
  async function withModels(models, action) {
    trouble.length = 0;
    const urls = models.map(({ model, resources = {} }) => {
      const folder = `/${++folders}`;
      const named = { ...resources, [modelName(model)]: model };
      for (const [uri, bytes] of Object.entries(named)) files.set(`${folder}/${decodeURIComponent(uri)}`, { body: Buffer.from(bytes) });
      return `${folder}/${modelName(model)}`;
    });
    const result = await action(...urls);
    for (const path of files.keys()) if (/^\/\d/.test(path)) files.delete(path);
    assert.deepEqual(trouble, []);
    return result;
  }

  return {
    /** { meshes, vertices, animations } as three loaded them. */
    describe: (model, resources) =>
      withModels([{ model, resources }], (url) => page.evaluate((where) => window.three.describe(where), url)),
    /** [{ what, covered, differing }]: shares of pixels, at rest and in a pose; `before` and `after`: { model, resources }. */
    difference: (before, after, tolerance = 8) => withModels([before, after],
      (...urls) => page.evaluate(([one, two, limit]) => window.three.difference(one, two, limit), [...urls, tolerance])),
    /** { before, after, difference: data: URLs, covered, most, mean }: levels of 255, those shown `amplify` times as large. */
    pictures: (before, after, amplify) => withModels([before, after],
      (...urls) => page.evaluate(([one, two, times]) => window.three.pictures(one, two, times), [...urls, amplify])),
    /** The GLB that GLTFExporter writes. */
    exported: async (model, resources) => Buffer.from(
      await withModels([{ model, resources }], (url) => page.evaluate((where) => window.three.exported(where), url)), 'base64'),
  };
}
