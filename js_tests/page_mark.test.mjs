// SPDX-License-Identifier: MIT
// The page marks: model, payload, key; room before, distortion and comparison after; what it hands out reads elsewhere.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import Ajv from 'ajv';
import { createKey, embed, extract } from 'quadmark';
import { generate } from 'quadmark/lab';
import { assertQuiet, drop, onDisk, openPage, save, screenshot, startBrowsers, waitFor, waitForView } from './page_helpers.mjs';
import { repository } from './support/files.mjs';
import { splitGlb } from './support/gltf.mjs';
import { logo, logoPng } from './support/marks.mjs';
import { webScene } from './support/scenes.mjs';

const { inEach } = await startBrowsers(after);
const { bytes: model } = await generate({ name: 'sculpture', vertices: 20000, format: 'glb' });
const textured = await webScene(20000);
const validate = new Ajv().compile(JSON.parse(readFileSync(join(repository, 'web/src/report/schema.json'))));

async function openMark(t, browser) {
  const { page, seen } = await openPage(t, browser);
  await page.locator('#tab-mark').click();
  return { page, seen };
}

const waitForMark = (page, ...states) => page.waitForFunction((wanted) => wanted.includes(document.getElementById('mark-outcome').dataset.state), states, { timeout: 120000 });

/** Pixels of the preview, 1 = ink. */
const preview = (page) => page.evaluate(() => {
  const canvas = document.getElementById('logo-preview');
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  return { width: canvas.width, height: canvas.height, bits: Array.from({ length: data.length / 4 }, (_, i) => (data[4 * i] === 0 ? 1 : 0)) };
});

inEach('a dropped model and logo are marked, compared and handed out', async (t, browser) => {
  const { page, seen } = await openMark(t, browser);
  await drop(page, onDisk(t, { 'statue.glb': model }).paths);
  await page.waitForFunction(() => /20,010 vertices, [\d,]+ places for the mark: pictures up to about 3\d × 3\d pixels fit\./.test(document.getElementById('room').textContent));
  assert.match(await page.locator('#mark-needs').innerText(), /^Still needed: a picture\.$/);
  await drop(page, onDisk(t, { 'emblem.png': logoPng(logo(24)) }).paths);
  await page.locator('#logo-adjust').waitFor({ state: 'visible' });
  await page.locator('#logo-size').fill('24');
  assert.deepEqual(await preview(page), { width: 24, height: 24, bits: [...logo(24).bits] });
  await page.locator('#owner-input').fill('Example Studio');
  await screenshot(page, '40-mark-ready');
  await page.locator('#mark-button').click();
  await waitForMark(page, 'done');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'mark-verdict');
  assert.match(await page.locator('#mark-proof').innerText(), /read back from the file; by accident that happens at most 1 in 10 to the power of \d+\.$/);
  const saved = {};
  for (const name of ['model', 'key', 'record']) saved[name] = await save(page, `#save-${name}`);
  assert.deepEqual(Object.values(saved).map(({ name }) => name), ['statue.marked.glb', 'statue.key.json', 'statue.marking.json']);
  const key = JSON.parse(saved.key.bytes);
  assert.deepEqual([key.scheme, key.owner], ['robust', 'Example Studio']);
  const read = await extract(saved.model.bytes, { key });
  assert.deepEqual([read.verdict, [...read.image.bits]], ['match', [...logo(24).bits]]);
  assert.deepEqual(Buffer.from((await embed(model, { key, image: logo(24) })).bytes), saved.model.bytes, 'the same bytes as elsewhere');
  const record = JSON.parse(saved.record.bytes);
  assert.ok(validate(record), JSON.stringify(validate.errors));
  assert.deepEqual(record.parameters, { scheme: 'robust', salt: '', strength: 'standard', payload: { image: { width: 24, height: 24 } } });
  assert.doesNotMatch(saved.record.bytes.toString(), /secret/);
  const facts = await page.locator('#mark-facts').innerText();
  for (const fact of [/Signal to noise\s+\d\d\.\d dB/, /Mean displacement \(RMS\), of the diagonal\s+\d/, /Bytes changed\s+[\d,]+/, /Mean change of normals\s+0\.\d°/]) assert.match(facts, fact);

  assert.equal(await waitForView(page, 'compare'), 'ready');
  const slider = page.locator('#compare input.split');
  await slider.focus();
  await page.keyboard.press('ArrowRight');
  assert.equal(await slider.inputValue(), '51');
  await page.locator('#compare .view-print').waitFor({ state: 'attached' });
  await screenshot(page, '41-mark-slider');
  await page.locator('#compare label', { hasText: 'Difference' }).click();
  assert.match(await page.locator('#compare .legend').innerText(), /0\s+0\.\d+ % of the diagonal/);
  assert.equal(await slider.isVisible(), false);
  await page.waitForTimeout(800);
  await screenshot(page, '42-mark-difference');
  assertQuiet(seen, browser.url);
});

inEach('logos may be SVG or JPEG; threshold, size and inversion show at once', async (t, browser) => {
  const { page, seen } = await openMark(t, browser);
  const svg = '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20"><rect width="20" height="20" fill="#333"/><rect x="20" width="20" height="20" fill="#aaa"/></svg>';
  await page.locator('#logo-input').setInputFiles(onDisk(t, { 'two.svg': svg }).paths[0]);
  await page.waitForFunction(() => document.getElementById('logo-told').textContent !== '');
  await page.locator('#logo-size').fill('16');
  const left = Array.from({ length: 16 * 8 }, (_, i) => (i % 16 < 8 ? 1 : 0));
  assert.deepEqual(await preview(page), { width: 16, height: 8, bits: left });
  await page.locator('#logo-threshold').fill('80');
  assert.deepEqual((await preview(page)).bits, left.map(() => 1), 'both are darker than 80 %');
  await page.locator('#logo-threshold').fill('40');
  await page.locator('#logo-invert').check();
  assert.deepEqual((await preview(page)).bits, left.map((bit) => 1 - bit));
  const jpeg = await page.evaluate(async () => {
    const canvas = new OffscreenCanvas(32, 32);
    const drawing = canvas.getContext('2d');
    drawing.fillStyle = '#fff';
    drawing.fillRect(0, 0, 32, 32);
    drawing.fillStyle = '#000';
    drawing.fillRect(0, 0, 32, 16);
    return [...new Uint8Array(await (await canvas.convertToBlob({ type: 'image/jpeg', quality: 0.95 })).arrayBuffer())];
  });
  await page.locator('#logo-invert').uncheck();
  await drop(page, onDisk(t, { 'half.jpg': Uint8Array.from(jpeg) }).paths);
  await page.waitForFunction(() => /half\.jpg/.test(document.getElementById('logo-file').textContent));
  assert.deepEqual((await preview(page)).bits, Array.from({ length: 256 }, (_, i) => (i < 128 ? 1 : 0)));
  await page.locator('#logo-input').setInputFiles(onDisk(t, { 'broken.png': 'no picture' }).paths[0]);
  await page.locator('#mark-notices li').waitFor();
  assert.equal(await page.locator('#mark-notices li').innerText(), 'broken.png cannot be shown as a picture. Give a PNG, JPEG or SVG.');
  assertQuiet(seen, browser.url);
});

inEach('an ID with a loaded key, a text with a passphrase, a textured glTF with its buffer', async (t, browser) => {
  const { page, seen } = await openMark(t, browser);
  const { gltf, bin } = splitGlb(textured, 'data.bin');
  const key = await createKey({ owner: 'loaded' });
  await drop(page, onDisk(t, { 'scene.gltf': gltf, 'data.bin': bin, 'key.json': key }).paths);
  await page.waitForFunction(() => document.getElementById('room').textContent.includes('places'));
  assert.equal(await page.locator('#mark-key-file').innerText().then((text) => text.split(' ')[0]), 'key.json');
  await page.locator('#payload-kinds label', { hasText: 'ID' }).click();
  await page.locator('#id-input').fill('xyz');
  assert.equal(await page.locator('#mark-button').isDisabled(), true);
  await page.locator('#id-input').fill('beef');
  await page.locator('#mark-button').click();
  await waitForMark(page, 'done');
  const gltfOut = await save(page, '#save-model'), binOut = await save(page, '#mark-saves a[download="data.bin"]');
  const read = await extract(gltfOut.bytes, { key, resources: { 'data.bin': binOut.bytes } });
  assert.deepEqual([read.verdict, read.id], ['match', '000000000000beef']);
  assert.match(await page.locator('#mark-facts').innerText(), /Textures slide by at most\s+0\.\d texels/);
  await page.locator('#payload-kinds label', { hasText: 'Text' }).click();
  await page.locator('#text-input').fill('© Söhne');
  await page.locator('#key-kinds label', { hasText: 'Passphrase' }).click();
  await page.locator('#mark-owner').fill('me');
  await page.locator('#mark-passphrase').fill('a long enough passphrase');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.activeElement.id === 'mark-button');
  const before = await page.locator('#save-key').getAttribute('href');
  await page.keyboard.press('Enter');
  await page.waitForFunction((old) => document.getElementById('mark-outcome').dataset.state === 'done' && document.getElementById('save-key').getAttribute('href') !== old, before, { timeout: 60000 });
  const phrase = await save(page, '#save-key');
  const textGltf = await save(page, '#save-model'), textBin = await save(page, '#mark-saves a[download="data.bin"]');
  const text = await extract(textGltf.bytes, { key: phrase.bytes, resources: { 'data.bin': textBin.bytes } });
  assert.deepEqual([text.verdict, text.text], ['match', '© Söhne']);
  assertQuiet(seen, browser.url);
});

inEach('what cannot be marked is said with the place', async (t, browser) => {
  const { page, seen } = await openMark(t, browser);
  await drop(page, onDisk(t, { 'cut.glb': model.subarray(0, 5000) }).paths);
  await waitForMark(page, 'problem');
  assert.equal(await page.locator('#mark-problem-title').innerText(), 'cut.glb cannot be read.');
  assert.match(await page.locator('#mark-problem-text').innerText(), /GLB|chunk|ends/);
  const { bytes: small } = await generate({ name: 'sculpture', vertices: 600, format: 'glb' });
  await drop(page, onDisk(t, { 'small.glb': small, 'emblem.png': logoPng(logo(64)) }).paths);
  await page.waitForFunction(() => document.getElementById('room').textContent.includes('This picture is larger'));
  await page.locator('#mark-button').click();
  await waitForMark(page, 'problem');
  assert.equal(await page.locator('#mark-problem-title').innerText(), 'small.glb has too little room for this mark.');
  await screenshot(page, '43-mark-refused');
  const { gltf } = splitGlb(model, 'data.bin');
  await drop(page, onDisk(t, { 'scene.gltf': gltf }).paths);
  await waitForMark(page, 'missing');
  assert.match(await page.locator('#mark-problem-text').innerText(), /^scene\.gltf keeps its geometry in data\.bin/);
  assertQuiet(seen, browser.url);
});

inEach('marking can be cancelled; the marked file then verifies on the other tab, under its salt', async (t, browser) => {
  const { page, seen } = await openMark(t, browser);
  const { bytes: large } = await generate({ name: 'sculpture', vertices: 300000, format: 'glb' });
  await page.locator('#payload-kinds label', { hasText: 'ID' }).click();
  await page.locator('#id-input').fill('1');
  await drop(page, onDisk(t, { 'large.glb': large }).paths);
  await page.waitForFunction(() => document.getElementById('room').textContent.includes('places'), null, { timeout: 60000 });
  await page.locator('#mark-button').click();
  await waitForMark(page, 'working');
  await page.locator('#mark-cancel').click();
  await waitForMark(page, 'idle');
  assert.equal(await page.locator('#mark-idle-text').innerText(), 'Cancelled. Nothing was marked.');
  await drop(page, onDisk(t, { 'statue.glb': model }).paths);
  await page.waitForFunction(() => document.getElementById('room').textContent.startsWith('20,010'));
  await page.locator('#mark-form summary', { hasText: 'More' }).click();
  await page.locator('#mark-salt-input').fill('statue no. 7');
  await page.locator('#mark-button').click();
  await waitForMark(page, 'done');
  const file = await save(page, '#save-model'), key = await save(page, '#save-key');
  await page.locator('#tab-mark').focus();
  await page.keyboard.press('ArrowLeft');
  await drop(page, onDisk(t, { [file.name]: file.bytes, [key.name]: key.bytes }).paths);
  await waitFor(page, 'none');
  await page.locator('#verify summary', { hasText: 'More' }).click();
  await page.locator('#salt-input').fill('statue no. 7');
  await page.keyboard.press('Enter');
  await waitFor(page, 'match');
  assert.equal(JSON.parse((await save(page, '#save-report')).bytes).parameters.salt, 'statue no. 7');
  assert.equal(await page.locator('#id-text').innerText(), '0000000000000001');
  assertQuiet(seen, browser.url);
});
