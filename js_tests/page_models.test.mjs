// SPDX-License-Identifier: MIT
// Many models at once: several files, a folder with buffers and textures, a zip; the queue, and cancelling it. Keys from
// passphrases.
import assert from 'node:assert/strict';
import { scrypt } from 'node:crypto';
import { join } from 'node:path';
import { after } from 'node:test';
import { promisify } from 'node:util';
import { strToU8, zipSync } from 'fflate';
import { createKey, embed } from 'quadmark';
import { generate } from 'quadmark/lab';
import { keyFromPassphrase } from 'quadmark/passphrase';
import { assertPicture, assertQuiet, drop, markedSculpture, onDisk, openPage, screenshot, shown, startBrowsers, waitFor } from './page_helpers.mjs';
import { splitGlb } from './support/gltf.mjs';
import { logo, logoPng } from './support/marks.mjs';

const { inEach, inChromium } = await startBrowsers(after);
const { model, marked, key, image } = await markedSculpture({ vertices: 3000 });
const ply = (await generate({ name: 'part', vertices: 3000, format: 'ply' })).bytes;

/** A glTF with its buffer and a texture, as a folder holds them. */
function sceneFiles(folder) {
  const { gltf, bin } = splitGlb(marked, 'buffers/data.bin');
  const json = { ...JSON.parse(gltf), images: [{ uri: 'textures/skin.png' }] };
  return { [`${folder}/scene.gltf`]: JSON.stringify(json), [`${folder}/buffers/data.bin`]: bin, [`${folder}/textures/skin.png`]: logoPng(logo(8, 8)) };
}

const rows = (page) => page.locator('#queue-rows tr').evaluateAll((list) => list.map((row) => [...row.children].slice(0, 2).map((cell) => cell.innerText)));
const finished = (page, n) => page.waitForFunction((all) => document.getElementById('queue-count').textContent === `${all} of ${all} checked`, n, { timeout: 120000 });

inEach('several models are checked one after another, each with its own result', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const { paths } = onDisk(t, { 'a-marked.glb': marked, 'b-unmarked.glb': model, 'c-broken.glb': marked.subarray(0, 5000), 'd-other.ply': ply, 'key.json': key });
  await drop(page, paths);
  await finished(page, 4);
  assert.deepEqual(await rows(page), [['a-marked.glb', 'Match'], ['b-unmarked.glb', 'No mark'], ['c-broken.glb', 'Not readable'], ['d-other.ply', 'No mark']]);
  await waitFor(page, 'match');
  await assertPicture(page, image);
  assert.match(await page.locator('#model-file').innerText(), /^4 models \(/);
  await page.waitForFunction(() => document.getElementById('announcer').textContent === 'All 4 models are checked; 1 carry the mark of this key.');
  await page.getByRole('button', { name: 'c-broken.glb' }).click();
  await waitFor(page, 'problem');
  assert.equal((await shown(page)).title, 'c-broken.glb cannot be read.');
  await page.getByRole('button', { name: 'b-unmarked.glb' }).click();
  await waitFor(page, 'none');
  await screenshot(page, '20-queue');
  assertQuiet(seen, browser.url);
});

inEach('a folder with models, buffers and textures is opened', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const { folder } = onDisk(t, { ...sceneFiles('asset/one'), ...sceneFiles('asset/two'), 'asset/plain.glb': model, 'asset/key.json': key, 'asset/notes.txt': 'free' });
  await drop(page, [join(folder, 'asset')]);
  await finished(page, 3);
  assert.deepEqual((await rows(page)).sort(), [['asset/one/scene.gltf', 'Match'], ['asset/plain.glb', 'No mark'], ['asset/two/scene.gltf', 'Match']]);
  assert.deepEqual((await shown(page)).notices, []);
  assertQuiet(seen, browser.url);
});

// WebDriver BiDi hands no folder to a chooser.
inChromium('a folder may be chosen as well', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const { folder } = onDisk(t, { ...sceneFiles('asset/one'), 'asset/plain.glb': model, 'asset/key.json': key });
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.locator('label', { has: page.locator('#folder-input') }).click()]);
  await chooser.setFiles(join(folder, 'asset'));
  await finished(page, 2);
});

inEach('a zip is opened like a folder', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const files = Object.fromEntries(Object.entries(sceneFiles('asset')).map(([name, bytes]) => [name, typeof bytes === 'string' ? strToU8(bytes) : new Uint8Array(bytes)]));
  await drop(page, onDisk(t, { 'delivery.zip': zipSync(files), 'key.json': key }).paths);
  await waitFor(page, 'match');
  await assertPicture(page, image);
  assert.match(await page.locator('#model-file').innerText(), /^scene\.gltf .* \+ 2 more$/);
  await page.reload();
  const broken = zipSync({ 'a.glb': new Uint8Array(marked) }).slice(0, 5000);
  await drop(page, onDisk(t, { 'broken.zip': broken, 'empty.zip': zipSync({ 'sub/': new Uint8Array() }), 'key.json': key }).paths);
  await page.waitForFunction(() => document.querySelectorAll('#notices li').length === 2);
  const { notices } = await shown(page);
  assert.match(notices[0], /^broken\.zip could not be unpacked: it is no zip file that can be read \(.+\)\.$/);
  assert.equal(notices[1], 'empty.zip holds no files.');
  assertQuiet(seen, browser.url);
});

inEach('cancelling ends the queue and the thread', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const large = (await generate({ name: 'sculpture', vertices: 250000, format: 'ply' })).bytes;
  await drop(page, onDisk(t, { 'a.glb': marked, 'b-large.ply': large, 'c.glb': marked, 'key.json': key }).paths);
  await page.waitForFunction(() => document.getElementById('working-name').textContent === 'b-large.ply' && document.getElementById('progress').dataset.stage === 'search');
  await page.locator('#cancel').click();
  await waitFor(page, 'idle');
  assert.deepEqual(await rows(page), [['a.glb', 'Match'], ['b-large.ply', 'Cancelled'], ['c.glb', 'Cancelled']]);
  for (let i = 0; i < 100 && page.workers().length > 0; ++i) await page.waitForTimeout(100);
  assert.equal(page.workers().length, 0, 'the thread is gone');
  await page.getByRole('button', { name: 'a.glb' }).click();
  await waitFor(page, 'match');
  assertQuiet(seen, browser.url);
});

inEach('a passphrase and its owner stand for a key, the same one everywhere', async (t, browser) => {
  const passphrase = 'correct horse battery staple', owner = 'Beispiel & Söhne';
  const options = { maxmem: 2 ** 28 };
  const derived = await keyFromPassphrase({ passphrase, owner }, (password, salt, { N, r, p, dkLen }) =>
    promisify(scrypt)(password, salt, dkLen, { N, r, p, ...options }));
  const large = (await generate({ name: 'sculpture', vertices: 8000, format: 'glb' })).bytes;
  const { bytes } = await embed(large, { key: derived, id: 'c0ffee' });
  const { page, seen } = await openPage(t, browser);
  await drop(page, onDisk(t, { 'model.glb': bytes }).paths);
  await page.locator('#passphrase summary').click();
  await page.locator('#verify-owner').fill(owner);
  await page.locator('#verify-passphrase').fill('too short');
  await page.locator('#verify-use').click();
  assert.match(await page.locator('#passphrase [role=status]').innerText(), /at least 12 characters/);
  await page.locator('#verify-passphrase').fill(passphrase);
  await page.keyboard.press('Enter');
  await waitFor(page, 'match');
  assert.equal(await page.locator('#id-text').innerText(), '0000000000c0ffee');
  assert.equal(await page.locator('#key-file').innerText(), `From the passphrase of ${owner}`);
  await screenshot(page, '21-passphrase');
  await page.locator('#passphrase summary').click();
  await page.locator('#verify-passphrase').fill('another horse battery staple');
  await page.locator('#verify-use').click();
  await waitFor(page, 'none');
  assertQuiet(seen, browser.url);
  await assert.rejects(keyFromPassphrase({ passphrase: 'short' }, () => {}), { code: 'bad_key' });
  const other = await createKey({ owner });
  assert.notEqual(other.secret, derived.secret);
});
