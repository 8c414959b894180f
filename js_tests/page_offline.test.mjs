// SPDX-License-Identifier: MIT
// Durable: after one visit the page works without a server, and as one file it works from a disk.
import assert from 'node:assert/strict';
import { cpSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { after, test } from 'node:test';
import { oneFilePolicy } from '../web/build/one_file.mjs';
import { servePage } from '../web/serve.mjs';
import { assertPicture, assertQuiet, drop, markedSculpture, onDisk, openPage, pageRoot, save, screenshot, startBrowsers, waitFor, waitForView } from './page_helpers.mjs';
import { compressGlb } from './support/draco.mjs';
import { temporaryFolder } from './support/files.mjs';

const { inEach } = await startBrowsers(after, { serviceWorkers: 'allow' });
const { marked, key, image } = await markedSculpture();

inEach('after the first visit everything works without the server', async (t, browser) => {
  const { server, url } = await servePage({ root: pageRoot });
  const { page, seen } = await openPage(t, { ...browser, url });
  await page.waitForFunction(() => document.getElementById('offline').textContent === 'Works offline', null, { timeout: 60000 });
  assertQuiet(seen, url);
  server.close();
  server.closeAllConnections();
  await page.reload();
  await page.locator('[data-sample="marked"]').click();
  await waitFor(page, 'match');
  assert.equal(await waitForView(page), 'ready', 'three.js is kept too');
  await drop(page, onDisk(t, { 'packed.glb': compressGlb(Buffer.from(marked)), 'key.json': key }).paths);
  await page.waitForFunction(() => document.getElementById('verdict-files').textContent.startsWith('packed.glb'), null, { timeout: 60000 });
  await assertPicture(page, image);
  await screenshot(page, '50-offline');
  assert.deepEqual(seen.trouble, []);
});

inEach('the page as one file verifies and marks from a disk, asking for nothing', async (t, browser) => {
  const path = join(temporaryFolder(t), 'kept.html');
  cpSync(join(pageRoot, 'quadmark.html'), path);
  const { page, seen } = await openPage(t, { ...browser, url: pathToFileURL(path).href });
  assert.equal(await page.locator('#one-file').isVisible(), false);
  await page.locator('[data-sample="wrong"]').click();
  await waitFor(page, 'none');
  await drop(page, onDisk(t, { 'sculpture.glb': marked, 'key.json': key }).paths);
  await waitFor(page, 'match');
  await assertPicture(page, image);
  assert.equal(await waitForView(page), 'ready');
  await screenshot(page, '51-one-file');
  assert.match(JSON.parse((await save(page, '#save-report')).bytes).inputs.model.sha256, /^[0-9a-f]{64}$/);
  await drop(page, onDisk(t, { 'packed.glb': compressGlb(Buffer.from(marked)) }).paths);
  await page.waitForFunction(() => document.getElementById('verdict-files').textContent.startsWith('packed.glb'), null, { timeout: 60000 });
  await page.locator('#tab-mark').click();
  await page.locator('#payload-kinds label', { hasText: 'ID' }).click();
  await page.locator('#id-input').fill('1');
  await page.locator('#mark-model-input').setInputFiles(onDisk(t, { 'sculpture.glb': marked }).paths);
  await page.locator('#mark-button:enabled').click();
  await page.waitForFunction(() => document.getElementById('mark-outcome').dataset.state === 'done', null, { timeout: 60000 });
  assert.deepEqual(seen.trouble, []);
  assert.deepEqual(seen.requests.filter((url) => !/^(data|blob):/.test(url) && url !== pathToFileURL(path).href), []);
});

test('the one file allows its own script and style, and no connection', () => {
  const html = readFileSync(join(pageRoot, 'quadmark.html'), 'utf8');
  const [, policy] = /http-equiv="Content-Security-Policy" content="([^"]*)"/.exec(html);
  const [, style] = /<style>(.*?)<\/style>/s.exec(html);
  const [, script] = /<script type="module">(.*)<\/script>/s.exec(html);
  assert.equal(policy, oneFilePolicy(script, style));
  assert.match(policy, /^default-src 'none'; script-src 'sha256-[^']+' 'wasm-unsafe-eval'; worker-src blob:; connect-src data:; style-src 'sha256-[^']+'; img-src blob: data:;/);
});
