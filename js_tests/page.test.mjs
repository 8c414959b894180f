// SPDX-License-Identifier: MIT
// The page finds marks: drop a model and a key, see the verdict, the probability and the picture.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { brotliCompressSync } from 'node:zlib';
import { createKey, embed, extract } from 'quadmark';
import { attack } from 'quadmark/lab';
import { assertPicture, assertQuiet, drop, markedSculpture, onDisk, openPage, pageRoot, picture, screenshot, shown, startBrowsers, waitFor } from './page_helpers.mjs';
import { realModel, repository } from './support/files.mjs';
import { splitGlb } from './support/gltf.mjs';
import { logo, logoPng } from './support/marks.mjs';

const { inEach, inChromium } = await startBrowsers(after);
const { model, marked, key, image } = await markedSculpture();

inEach('the page loads quietly, and nothing is asked of any other origin', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  assert.equal(await page.title(), 'quadmark: is this model marked?');
  assert.equal(await page.locator('#check').isDisabled(), true);
  await screenshot(page, '01-idle');
  assertQuiet(seen, browser.url);
});

inChromium('a first visit fetches at most 450 kB up to its verdict', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  await drop(page, onDisk(t, { 'sculpture.glb': marked, 'key.json': key }).paths);
  await waitFor(page, 'match');
  const names = new Set(seen.requests.map((url) => new URL(url).pathname.slice(1) || 'index.html').filter((name) => existsSync(join(pageRoot, name))));
  assert.ok(names.size >= 5, [...names].join());
  const sizes = [...names].filter((name) => !/scene-|worker-/.test(name)).map((name) => brotliCompressSync(readFileSync(join(pageRoot, name))).length);
  const total = sizes.reduce((a, b) => a + b, 0);
  t.diagnostic(`${names.size} files, ${total} bytes after brotli`);
  assert.ok(total <= 450e3, `${total} bytes`);
});

inEach('a marked GLB and its key, dropped together, give a match and the exact picture', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const { paths } = onDisk(t, { 'sculpture.glb': marked, 'key.json': key });
  await drop(page, paths);
  await waitFor(page, 'match');
  const { verdict, odds } = await shown(page);
  assert.equal(verdict, 'This model carries the mark of this key.');
  assert.match(odds, /^1 in 10\s*\d{2,3}$/);
  await assertPicture(page, image);
  assert.match(await page.locator('#verdict-files').innerText(), /sculpture\.glb · key\.json · key of the tests/);
  await screenshot(page, '02-match');
  assert.ok(seen.requests.some((url) => url.endsWith('.wasm')), 'requests of the worker are watched too');
  assertQuiet(seen, browser.url);
});

inChromium('the verdict is spoken through the live region', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const announcer = page.locator('#announcer');
  assert.equal(await announcer.getAttribute('aria-live'), 'polite');
  const { paths } = onDisk(t, { 'sculpture.glb': marked, 'key.json': key });
  await drop(page, paths);
  await waitFor(page, 'match');
  await page.waitForFunction(() => /^Match: This model carries .* 1 in 10 to the power of \d+\.$/.test(document.getElementById('announcer').textContent));
  assert.match((await shown(page)).spokenOdds, /^1 in 10 to the power of \d+$/);
});

inEach('a reference picture is shown and compared', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const { paths } = onDisk(t, { 'sculpture.glb': marked, 'key.json': key, 'logo.png': logoPng(image) });
  await drop(page, paths);
  await waitFor(page, 'match');
  assert.equal(await page.locator('#reference-caption').innerText(), 'is the same in every pixel');
  const reference = await picture(page, 'reference');
  assert.deepEqual(reference.levels, Array.from(image.bits, (bit) => (bit ? 0 : 255)));
  const other = { ...image, bits: image.bits.map((bit, i) => (i < 7 ? 1 - bit : bit)) };
  await drop(page, onDisk(t, { 'other.png': logoPng(other) }).paths);
  await page.waitForFunction(() => document.getElementById('reference-caption').textContent === 'differs in 7 pixels of the 576 that were read');
  await screenshot(page, '03-match-with-reference');
  assertQuiet(seen, browser.url);
});

inChromium('files may come one by one, in any order', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const { paths: [glb, json] } = onDisk(t, { 'sculpture.glb': marked, 'key.json': key });
  await drop(page, [json]);
  await page.waitForFunction(() => document.getElementById('idle-text').textContent === 'The key is here. Now add the model.');
  await screenshot(page, '04-key-only');
  await drop(page, [glb]);
  await waitFor(page, 'match');
  await assertPicture(page, image);
});

inChromium('a marked PLY gives a match and the exact picture', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const ply = await markedSculpture({ format: 'ply' });
  await drop(page, onDisk(t, { 'sculpture.ply': ply.marked, 'my key.json': ply.key }).paths);
  await waitFor(page, 'match');
  await assertPicture(page, ply.image);
  assertQuiet(seen, browser.url);
});

inEach('a marked glTF is read with its .bin, dropped as files or as their folder', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const { gltf, bin } = splitGlb(marked, 'mesh%20data.bin');
  const loose = onDisk(t, { 'scene.gltf': gltf, 'mesh data.bin': bin, 'key.json': key });
  await drop(page, loose.paths);
  await waitFor(page, 'match');
  await assertPicture(page, image);
  await page.reload();
  const inFolder = splitGlb(marked, 'buffers/data.bin');
  const { folder } = onDisk(t, {
    'scene/scene.gltf': inFolder.gltf, 'scene/buffers/data.bin': inFolder.bin, 'scene/key.json': key, 'scene/license.txt': 'free',
  });
  await drop(page, [join(folder, 'scene')]);
  await waitFor(page, 'match');
  await assertPicture(page, image);
  assert.deepEqual((await shown(page)).notices, []);
  assertQuiet(seen, browser.url);
});

inChromium('textures of a glTF are not taken for the reference', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const { gltf, bin } = splitGlb(marked, 'data.bin');
  const json = JSON.parse(gltf);
  json.images = [{ uri: 'skin.png' }];
  await drop(page, onDisk(t, { 'scene.gltf': json, 'data.bin': bin, 'skin.png': logoPng(logo(10, 10)), 'key.json': key }).paths);
  await waitFor(page, 'match');
  assert.equal(await page.locator('#reference-figure').isVisible(), false);
});

inChromium('a damaged model still matches, with unread pixels said', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const crop = await attack(marked, { kind: 'crop', amount: 0.9, format: 'glb' });
  const damaged = await attack(crop.bytes, { kind: 'noise', amount: 4e-6, format: 'glb' });
  const expected = await extract(damaged.bytes, { key });
  assert.equal(expected.verdict, 'match');
  await drop(page, onDisk(t, { 'damaged.glb': damaged.bytes, 'key.json': key }).paths);
  await waitFor(page, 'match');
  const { levels } = await picture(page, 'image');
  assert.deepEqual(levels, Array.from(expected.image.bits, (bit, i) => (expected.image.erased[i] ? 128 : bit ? 0 : 255)));
  const confidence = await picture(page, 'confidence');
  assert.deepEqual([confidence.width, confidence.height], [24, 24]);
  expected.image.confidence.forEach((value, i) => assert.ok(Math.abs(confidence.levels[i] - 255 * value) <= 1, `pixel ${i}`));
  const [large, beside] = await Promise.all(['#image', '#confidence'].map((id) => page.locator(id).boundingBox()));
  assert.ok(large.width > beside.width && beside.x >= large.x + large.width, 'the picture is large, the confidence beside it');
  const unread = expected.image.erased.reduce((sum, bit) => sum + bit, 0);
  assert.match(await page.locator('#image-caption').innerText(), unread > 0 ? new RegExp(`${unread} pixels? could not be read`) : /^24 × 24$/);
  await screenshot(page, '05-damaged');
});

inChromium('a wrong key and an unmarked model both read as no mark', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const wrong = await createKey({ width: 24, height: 24 });
  for (const [name, files] of [['wrong-key', { 'sculpture.glb': marked, 'wrong.json': wrong }], ['unmarked', { 'sculpture.glb': model, 'key.json': key }]]) {
    await page.reload();
    await drop(page, onDisk(t, files).paths);
    await waitFor(page, 'none', 'match', 'inconclusive');
    const { verdict, odds } = await shown(page);
    assert.equal(verdict, 'No mark of this key was found.', name);
    assert.doesNotMatch(odds, /million|10\s*\d\d/, name);
    assert.match(await page.locator('#image-caption').innerText(), /shows noise/);
    assert.equal(await page.locator('#confidence').isVisible(), false, 'no certainty is shown beside noise');
    await screenshot(page, `06-${name}`);
  }
  assertQuiet(seen, browser.url);
});

inChromium('a hidden ID is shown in hexadecimal', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const idKey = await createKey({ id: true, owner: 'Zoë <b>& Co</b>' });
  const { bytes } = await embed(model, { key: idKey, id: 'c0ffee' });
  await drop(page, onDisk(t, { 'numbered.glb': bytes, 'key.json': idKey }).paths);
  await waitFor(page, 'match');
  assert.equal(await page.locator('#id-text').innerText(), '0000000000c0ffee');
  assert.equal(await page.locator('#image').isVisible(), false);
  assert.match(await page.locator('#verdict-files').innerText(), /key of Zoë <b>& Co<\/b>$/);
  await screenshot(page, '07-id');
  assertQuiet(seen, browser.url);
});

inEach('the samples show a match, a damaged match, no mark, and no mark under a wrong key', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const samples = join(repository, 'web/samples');
  const [sampleKey, marks, damaged, sampleLogo] = await Promise.all(['key.json', 'marked.glb', 'damaged.glb', 'logo.png'].map((name) => readFile(join(samples, name))));
  await page.locator('[data-sample="marked"]').click();
  await waitFor(page, 'match');
  await assertPicture(page, (await extract(marks, { key: sampleKey })).image);
  assert.equal(await page.locator('#reference-caption').innerText(), 'is the same in every pixel');
  assert.equal(await page.locator('#agreement').innerText(), '100 % agreement');
  assert.equal(await page.locator('#confidence-figure').isVisible(), false, 'nothing is drawn where every pixel is certain');
  await screenshot(page, '08-sample');
  for (const name of ['unmarked', 'wrong']) {
    await page.locator(`[data-sample="${name}"]`).click();
    await page.waitForFunction((file) => document.getElementById('verdict-files').textContent.startsWith(file), name === 'wrong' ? 'marked.glb · wrong' : 'unmarked.glb');
    await waitFor(page, 'none');
    assert.equal(await page.locator('#pictures').isVisible(), false, 'scheme robust shows no picture where there is none');
    await screenshot(page, `08-sample-${name}`);
  }
  assert.match(await page.locator('#verdict-files').innerText(), /wrong-key\.json · key of somebody else$/);
  await page.locator('[data-sample="damaged"]').click();
  await waitFor(page, 'match');
  const { image } = await extract(damaged, { key: sampleKey, reference: sampleLogo });
  assert.deepEqual((await picture(page, 'image')).levels, Array.from(image.bits, (bit, i) => (image.erased[i] ? 128 : bit ? 0 : 255)));
  assert.match(await page.locator('#reference-caption').innerText(), /differs in \d+ pixels/);
  assert.match(await page.locator('#agreement').innerText(), /^9\d(\.\d)? % agreement$/);
  await screenshot(page, '09-sample-damaged');
  assertQuiet(seen, browser.url);
});

inChromium('real models read on the page as they do in Node', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  for (const name of ['bunny.glb', 'fandisk.ply', 'igea-tristrips.ply']) {
    const path = realModel(t, name);
    if (!path) continue;
    const { bytes } = await embed(await readFile(path), { key, image });
    await page.reload();
    await drop(page, onDisk(t, { [name]: bytes, 'key.json': key }).paths);
    await waitFor(page, 'match');
    await assertPicture(page, image);
  }
  assertQuiet(seen, browser.url);
});
