// SPDX-License-Identifier: MIT
// The page in Firefox ESR: the same work as in Chromium, in short.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { createKey, embed, extract } from 'quadmark';
import { generate } from 'quadmark/lab';
import { servePage } from '../web/serve.mjs';
import { markedSculpture, onDisk, pageRoot, screenshots } from './page_helpers.mjs';
import { noFirefox, startFirefox } from './support/firefox.mjs';
import { splitGlb } from './support/gltf.mjs';
import { logo, logoPng } from './support/marks.mjs';

const options = { skip: noFirefox, timeout: 240000 };
const browser = noFirefox ? null : await startFirefox(after);
mkdirSync(screenshots, { recursive: true });
const { server, url } = await servePage({ root: pageRoot });
after(() => {
  server.close();
  server.closeAllConnections();
});
const { marked, key, image } = await markedSculpture({ vertices: 3000 });

async function openPage(t, address = url) {
  const page = await browser.newPage();
  t.after(() => page.close());
  const trouble = [], requests = [];
  page.on('console', (message) => { if (message.type() === 'error') trouble.push(message.text()); });
  page.on('pageerror', (error) => trouble.push(error.message));
  page.on('request', (request) => requests.push(request.url()));
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(address);
  return { page, trouble, requests };
}

const state = (page, id, ...wanted) => page.waitForFunction((name, states) => states.includes(document.getElementById(name).dataset.state), { timeout: 120000 }, id, wanted);
const text = (page, selector) => page.$eval(selector, (found) => found.textContent);
const choose = async (page, selector, paths) => (await page.$(selector)).uploadFile(...paths);

function assertQuiet({ trouble, requests }) {
  assert.deepEqual(trouble, []);
  assert.deepEqual(requests.filter((request) => !request.startsWith(url) && !/^(data|blob):/.test(request)), []);
}

/** Drops files as the browser's own drag and drop hands them over: BiDi cannot carry files into a drag. */
async function drop(page, files) {
  await page.evaluate((all) => {
    const transfer = new DataTransfer();
    for (const [name, base64] of all) transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, Object.entries(files).map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]));
}

test('samples: a match with its picture and the 3D view, and no mark', options, async (t) => {
  const seen = await openPage(t);
  const { page } = seen;
  await page.click('[data-sample="damaged"]');
  await state(page, 'outcome', 'match');
  assert.match(await text(page, '#agreement'), /^9\d(\.\d)? % agreement$/);
  await page.$eval('#view', (view) => view.scrollIntoView());
  await state(page, 'view', 'ready');
  await page.waitForSelector('.view-print');
  await page.screenshot({ path: join(screenshots, '70-firefox-match.png') });
  await page.focus('#view canvas');
  const before = await page.$eval('.view-print', ({ src }) => src);
  await page.keyboard.press('ArrowLeft');
  await page.waitForFunction((old) => document.querySelector('.view-print').src !== old, {}, before);
  await page.click('[data-sample="wrong"]');
  await state(page, 'outcome', 'none');
  assert.equal(await text(page, '#verdict-title'), 'No mark of this key was found.');
  assertQuiet(seen);
});

test('files chosen and files dropped, a glTF with its buffer, several models', options, async (t) => {
  const seen = await openPage(t);
  const { page } = seen;
  const { gltf, bin } = splitGlb(marked, 'data.bin');
  const { paths } = onDisk(t, { 'scene.gltf': gltf, 'data.bin': bin, 'key.json': key, 'logo.png': logoPng(image) });
  await choose(page, '#model-input', paths.slice(0, 2));
  await choose(page, '#key-input', [paths[2]]);
  await choose(page, '#reference-input', [paths[3]]);
  await state(page, 'outcome', 'match');
  await page.waitForFunction(() => document.getElementById('reference-caption').textContent === 'is the same in every pixel');
  await drop(page, { 'a.glb': marked, 'b.glb': marked.subarray(0, 4000), 'key.json': JSON.stringify(key) });
  await page.waitForFunction(() => document.getElementById('queue-count').textContent === '2 of 2 checked', { timeout: 60000 });
  assert.deepEqual(await page.$$eval('#queue-rows td:nth-child(2)', (cells) => cells.map((cell) => cell.textContent)), ['Match', 'Not readable']);
  assertQuiet(seen);
});

test('broken files get a sentence with the place, and a check can be cancelled', options, async (t) => {
  const seen = await openPage(t);
  const { page } = seen;
  await drop(page, { 'cut.glb': marked.subarray(0, marked.length >> 1), 'key.json': JSON.stringify(key) });
  await state(page, 'outcome', 'problem');
  assert.equal(await text(page, '#problem-title'), 'cut.glb cannot be read.');
  assert.match(await text(page, '#problem-text'), /GLB|chunk|ends/);
  const large = await generate({ name: 'sculpture', vertices: 300000, format: 'ply' });
  await choose(page, '#model-input', onDisk(t, { 'large.ply': large.bytes }).paths);
  await page.waitForFunction(() => document.getElementById('progress').dataset.stage === 'search');
  await page.click('#cancel');
  await state(page, 'outcome', 'idle');
  await drop(page, { 'small.glb': marked });
  await state(page, 'outcome', 'match');
  assertQuiet(seen);
});

test('marking gives the same bytes as elsewhere', options, async (t) => {
  const seen = await openPage(t);
  const { page } = seen;
  await page.click('#tab-mark');
  const { bytes: model } = await generate({ name: 'sculpture', vertices: 20000, format: 'glb' });
  const loaded = await createKey({ owner: 'firefox' });
  await drop(page, { 'statue.glb': model, 'logo.png': logoPng(logo(24)), 'key.json': JSON.stringify(loaded) });
  await page.waitForSelector('#mark-button:enabled');
  await page.$eval('#logo-size', (slider) => {
    slider.value = 24;
    slider.dispatchEvent(new Event('input'));
  });
  await page.click('#mark-button');
  await state(page, 'mark-outcome', 'done');
  const hash = await page.$$eval('#mark-facts dd', (facts) => facts.at(-1).textContent);
  const { bytes } = await embed(model, { key: loaded, image: logo(24) });
  assert.equal(hash, createHash('sha256').update(bytes).digest('hex'));
  assert.equal((await extract(bytes, { key: loaded })).verdict, 'match');
  await page.$eval('#compare', (view) => view.scrollIntoView());
  await state(page, 'compare', 'ready');
  assertQuiet(seen);
});

test('offline after the first visit, and as one file from the disk', options, async (t) => {
  const local = await servePage({ root: pageRoot });
  const { page } = await openPage(t, local.url);
  await page.waitForFunction(() => document.getElementById('offline').textContent === 'Works offline', { timeout: 60000 });
  local.server.close();
  local.server.closeAllConnections();
  await page.reload();
  await page.click('[data-sample="marked"]');
  await state(page, 'outcome', 'match');
  const file = await openPage(t, pathToFileURL(join(pageRoot, 'quadmark.html')).href);
  await file.page.click('[data-sample="marked"]');
  await state(file.page, 'outcome', 'match');
  assert.deepEqual(file.trouble, []);
});
