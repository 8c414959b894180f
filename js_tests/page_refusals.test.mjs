// SPDX-License-Identifier: MIT
// The page on wrong input: a sentence that names the file and the place, never a verdict; and cancelling.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { generate } from 'quadmark/lab';
import { assertPicture, assertQuiet, drop, markedSculpture, onDisk, openPage, picture, screenshot, shown, startBrowsers, waitFor } from './page_helpers.mjs';
import { splitGlb } from './support/gltf.mjs';
import { logo, logoPng } from './support/marks.mjs';

const { inEach, inChromium } = await startBrowsers(after);
const { marked, key, image } = await markedSculpture({ vertices: 2500 });
const ply = (rows, faces = ['3 0 1 2', '3 0 2 3'], count = faces.length) => `ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z
element face ${count}\nproperty list uchar int vertex_indices\nend_header\n${rows}\n${faces.map((face) => `${face}\n`).join('')}`;
const SQUARE = '0 0 0\n1 0 0\n1 1 0\n0 1 0.5';

/** Drops `files` on a fresh page and returns what it shows once it has decided. */
async function refuse(t, page, files) {
  await page.reload();
  await drop(page, onDisk(t, files).paths);
  await waitFor(page, 'problem', 'missing', 'match', 'none', 'inconclusive');
  const seen = await shown(page);
  assert.equal(seen.verdict, null, 'no verdict is shown');
  for (const text of [seen.title, seen.problem]) assert.match(text, /^\S+ .*[^.]\.$/s, 'a whole sentence');
  return seen;
}

inEach('broken models are refused with the file and the place', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const lying = Buffer.from(marked);
  lying.writeUInt32LE(0xfffffff0, 12);  // the length of the JSON chunk
  const cases = [
    ['empty.glb', new Uint8Array(0), /^empty\.glb cannot be read\.$/, /empty/],
    ['magic.glb', Buffer.from('Kaydara FBX Binary  \0'), /^magic\.glb cannot be read\.$/, /not a PLY, glTF, GLB or DRC.*Kaydara/],
    ['cut.glb', marked.subarray(0, marked.length >> 1), /^cut\.glb cannot be read\.$/, /GLB|chunk|ends/],
    ['lying.glb', lying, /^lying\.glb cannot be read\.$/, /chunk|JSON|length/],
    ['cut.ply', ply(SQUARE).slice(0, -20), /^cut\.ply cannot be read\.$/, /vertex|face/],
    ['lying.ply', ply(SQUARE, undefined, 4e9), /^lying\.ply cannot be read\.$/, /element "face": 4000000000 rows/],
    ['index.ply', ply(SQUARE, ['3 0 1 9']), /^index\.ply cannot be read\.$/, /face 0: vertex index 9/],
    ['points.ply', ply(SQUARE, []), /^points\.ply has no usable surface\.$/, /no faces/],
    ['nan.ply', ply('0 0 0\n1 0 0\n1 nan 0\n0 1 0.5'), /^nan\.ply has no usable surface\.$/, /vertex 2/],
    ['inf.ply', ply('0 0 0\n1 0 0\n1 1 0\n0 -inf 0.5'), /^inf\.ply has no usable surface\.$/, /vertex 3, property y/],
    ['broken.gltf', '{"asset": {"version": "2.0"', /^broken\.gltf cannot be read\.$/, /JSON/],
    ['hello.gltf', '{"hello": 1}', /^hello\.gltf cannot be read\.$/, /./],
  ];
  for (const [name, bytes, title, place] of cases) {
    const told = await refuse(t, page, { [name]: bytes, 'key.json': key });
    assert.match(told.title, title, name);
    assert.match(told.problem, place, name);
    assert.notEqual(told.hint, '', name);
    if (name === 'nan.ply') await screenshot(page, '10-nan');
    await page.waitForFunction((text) => document.getElementById('announcer').textContent.startsWith(text), told.title);
  }
  assertQuiet(seen, browser.url);
});

inEach('broken keys and unfitting references are refused under their own names', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const cases = [
    [{ 'bad.json': '{' }, /^bad\.json is not a usable key\.$/, /key file/i],
    [{ 'bad.json': '{"a": 1}' }, /^bad\.json is not a usable key\.$/, /quadmark/],
    [{ 'short.json': { ...key, secret: 'AAAA' } }, /^short\.json is not a usable key\.$/, /secret/],
    [{ 'newer.json': { ...key, quadmark: 99 } }, /^newer\.json is of a newer version\.$/, /99/],
    [{ 'scheme.json': { ...key, scheme: 'magic' } }, /^scheme\.json is not a usable key\.$/, /scheme "magic"/],
    [{ 'key.json': key, 'pixel.png': logoPng({ width: 1, height: 1, bits: [1] }) }, /^pixel\.png does not fit\.$/, /single pixel/],
    [{ 'key.json': key, 'wide.png': logoPng({ width: 1500, height: 2, bits: new Uint8Array(3000) }) }, /^wide\.png is too large\.$/, /1500 x 2 pixels, at most 1024/],
    [{ 'key.json': key, 'small.png': logoPng(logo(10, 10)) }, /^small\.png does not fit\.$/, /10 x 10.*24 x 24/],
    [{ 'key.json': key, 'cut.png': logoPng(image).subarray(0, 40) }, /^cut\.png does not fit\.$/, /./],
  ];
  for (const [files, title, place] of cases) {
    const told = await refuse(t, page, { 'model.glb': marked, ...files });
    assert.match(told.title, title);
    assert.match(told.problem, place);
  }
  await screenshot(page, '11-reference');
  assertQuiet(seen, browser.url);
});

inEach('a glTF without its buffers names them, and goes on when they come', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const { gltf, bin } = splitGlb(marked, 'mesh%20data.bin');
  const told = await refuse(t, page, { 'scene.gltf': gltf, 'key.json': key });
  assert.equal(told.state, 'missing');
  assert.equal(told.title, 'One more file is needed.');
  assert.match(told.problem, /^scene\.gltf keeps its geometry in mesh data\.bin, which was not among the files\.$/);
  await screenshot(page, '12-missing');
  await drop(page, onDisk(t, { 'mesh data.bin': bin }).paths);
  await waitFor(page, 'match');
  await assertPicture(page, image);

  await page.reload();  // the other way round
  await drop(page, onDisk(t, { 'mesh data.bin': bin }).paths);
  await page.waitForFunction(() => /mesh data\.bin is here\. Now add the \.gltf/.test(document.getElementById('idle-text').textContent));
  await drop(page, onDisk(t, { 'scene.gltf': gltf, 'key.json': key }).paths);
  await waitFor(page, 'match');

  const remote = JSON.parse(gltf);
  remote.buffers[0].uri = 'https://example.invalid/mesh.bin';
  const far = await refuse(t, page, { 'scene.gltf': remote, 'key.json': key });
  assert.match(far.problem, /https:\/\/example\.invalid\/mesh\.bin/);
  assertQuiet(seen, browser.url);  // above all: it was not fetched
});

inEach('files of no use, and two keys at once, are said and change nothing', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  await drop(page, onDisk(t, { 'photo.jpg': 'not one of ours' }).paths);
  await page.locator('#notices li').waitFor();
  assert.deepEqual((await shown(page)).notices, ['photo.jpg was left aside: it is neither a model (GLB, glTF, PLY, DRC), nor a key file, nor a PNG picture.']);
  await drop(page, onDisk(t, { 'a.glb': marked, 'one.json': key, 'two.json': key }).paths);
  await page.waitForFunction(() => document.getElementById('idle-text').textContent === 'The model is here. Now add the key file.');
  assert.deepEqual((await shown(page)).notices, ['2 key files at once (one.json, two.json): give one at a time.']);
  await screenshot(page, '13-two-keys');
  await drop(page, onDisk(t, { 'key.json': key }).paths);
  await waitFor(page, 'match');
  assert.deepEqual((await shown(page)).notices, [], 'old notices go');
  assertQuiet(seen, browser.url);
});

inChromium('text dragged onto the page is answered, and never opened', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const session = await page.context().newCDPSession(page);
  const event = { x: 300, y: 300, data: { items: [{ mimeType: 'text/plain', data: 'hello' }], dragOperationsMask: 1 } };
  for (const type of ['dragEnter', 'dragOver']) await session.send('Input.dispatchDragEvent', { ...event, type });
  assert.equal(await page.locator('#veil').isVisible(), false);
  await page.evaluate(() => {
    const transfer = new DataTransfer();
    transfer.setData('text/plain', 'hello');
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
  });
  assert.match((await shown(page)).notices[0], /^That was no file\./);
});

inEach('the veil shows while files hang over the page', async (t, browser) => {
  const { page } = await openPage(t, browser);
  await drop(page, onDisk(t, { 'a.glb': marked }).paths, { hanging: async () => {
    await page.locator('#veil').waitFor({ state: 'visible' });
    await screenshot(page, '14-veil');
  } });
  if (browser.name === 'Firefox') await page.waitForFunction(() => document.getElementById('veil').hidden);
  assert.equal(await page.locator('#outcome').getAttribute('data-state'), 'idle');
});

inEach('everything is reached with the keyboard alone', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const order = [];
  for (let i = 0; i < 14; ++i) {
    await page.keyboard.press('Tab');
    order.push(await page.evaluate(() => document.activeElement.id || document.activeElement.dataset.sample || document.activeElement.className || document.activeElement.localName));
  }
  assert.deepEqual(order, ['skip', 'tab-verify', 'language', 'model-input', 'folder-input', 'key-input', 'summary', 'reference-input', 'summary', 'marked', 'damaged', 'unmarked', 'wrong', 'one-file']);
  const { paths: [glb, json] } = onDisk(t, { 'model.glb': marked, 'key.json': key });
  for (const [input, file] of [['model-input', glb], ['key-input', json]]) {
    await page.locator(`#${input}`).focus();
    const outline = await page.locator('label', { has: page.locator(`#${input}`) }).evaluate((label) => getComputedStyle(label).outlineStyle);
    assert.equal(outline, 'solid', 'the focused button is outlined');
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.keyboard.press('Space')]);
    await chooser.setFiles(file);
  }
  await waitFor(page, 'match');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'verdict', 'the focus goes to the verdict');
  await page.locator('[data-clear="key"]').focus();
  await page.keyboard.press('Enter');
  await waitFor(page, 'idle');
  assert.equal(await page.locator('#check').isDisabled(), true);
  assert.equal(await page.evaluate(() => document.activeElement.id), 'key-input', 'the focus stays nearby');
  assertQuiet(seen, browser.url);
});

inEach('a file chosen for the wrong slot is explained', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const { paths: [glb, json] } = onDisk(t, { 'model.glb': marked, 'key.json': key });
  await page.locator('#model-input').setInputFiles(json);
  await page.locator('#key-input').setInputFiles(json);
  await waitFor(page, 'problem');
  assert.equal((await shown(page)).title, 'key.json cannot be read.');
  await page.locator('#model-input').setInputFiles(glb);
  await waitFor(page, 'match');
  await page.locator('#key-input').setInputFiles(glb);
  await waitFor(page, 'problem');
  assert.equal((await shown(page)).title, 'model.glb is not a usable key.');
});

inEach('a check can be cancelled, and another one follows', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const large = await generate({ name: 'sculpture', vertices: 400000, format: 'ply' });
  await drop(page, onDisk(t, { 'large.ply': large.bytes, 'key.json': key }).paths);
  await page.waitForFunction(() => document.getElementById('progress').dataset.stage === 'search');
  assert.equal(await page.locator('#outcome').getAttribute('aria-busy'), 'true');
  assert.ok(page.workers().length > 0);
  await screenshot(page, '15-working');
  await page.locator('#cancel').click();
  await waitFor(page, 'idle');
  assert.equal(await page.locator('#idle-text').innerText(), 'Cancelled. Nothing was decided about this model.');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'check');
  // Chromium lets a busy thread finish for two seconds before it breaks it off.
  for (let i = 0; i < 100 && page.workers().length > 0; ++i) await page.waitForTimeout(100);
  assert.equal(page.workers().length, 0, 'the thread is gone, not only hidden');
  await drop(page, onDisk(t, { 'small.glb': marked }).paths);
  await waitFor(page, 'match');
  await assertPicture(page, image);
  assertQuiet(seen, browser.url);
});

inEach('new files during a check replace it', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const large = await generate({ name: 'sculpture', vertices: 150000, format: 'glb' });
  await drop(page, onDisk(t, { 'large.glb': large.bytes, 'key.json': key }).paths);
  await page.waitForFunction(() => document.getElementById('progress').dataset.stage === 'search');
  await drop(page, onDisk(t, { 'small.glb': marked }).paths);
  await waitFor(page, 'match');
  assert.match(await page.locator('#verdict-files').innerText(), /^small\.glb/);
  await page.waitForTimeout(1500);  // the first check would have ended by now
  assert.match(await page.locator('#verdict-files').innerText(), /^small\.glb/);
  assert.equal((await picture(page, 'image')).width, 24);
  assertQuiet(seen, browser.url);
});
