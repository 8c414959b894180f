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
const modules = join(repository, 'node_modules');
// Where the page finds them: three's decoder, and the encoder of which its DRACOExporter wants the script loaded.
const dracoFiles = Object.entries({
  '/draco/draco_wasm_wrapper.js': 'three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js',
  '/draco/draco_decoder.wasm': 'three/examples/jsm/libs/draco/gltf/draco_decoder.wasm',
  '/draco_encoder.js': 'draco3dgltf/draco_encoder_gltf_nodejs.js',
  '/draco_encoder.wasm': 'draco3dgltf/draco_encoder.wasm',
});

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
  context.setDefaultTimeout(120_000);  // software draws, perhaps beside other work
  const page = await context.newPage();
  const files = new Map([
    ['/', { contentType: 'text/html', body: '<!doctype html><script src="draco_encoder.js"></script><script type="module" src="scene.js"></script>' }],
    ['/scene.js', { contentType: 'text/javascript', body: script }],
    ...dracoFiles.map(([url, path]) => [url, { body: readFileSync(join(modules, path)) }]),
  ]);
  const trouble = [];
  page.on('console', (message) => { if (message.type() === 'error') trouble.push(message.text()); });
  page.on('pageerror', (error) => trouble.push(error.message));
  await context.route(`${origin}/**`, (route) => {
    const file = files.get(decodeURIComponent(new URL(route.request().url()).pathname));
    return route.fulfill(file ?? { status: 404 });
  });
  await page.goto(`${origin}/`, { timeout: 120_000 });  // it starts WebGL by software, which takes its time on a busy machine
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
    /** What one of three's exporters writes: GLTFExporter, DRACOExporter, PLYExporter (ascii); OBJ and STL, back as a GLB. */
    written: async (exporter, model, resources) => Buffer.from(await withModels([{ model, resources }],
      (url) => page.evaluate(([where, name]) => window.three.written(where, name), [url, exporter])), 'base64'),
    /** Three's revision. */
    version: () => page.evaluate(() => window.three.revision),
  };
}
