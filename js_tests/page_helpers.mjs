// SPDX-License-Identifier: MIT
// The built page in a real Chromium and a real Firefox: served under its policy, watched for anything it must not do, and
// used as a person does (files dropped through the browser's own drag and drop, buttons, keys). Test bodies are written in
// Playwright's words; support/firefox_page.mjs knows those they use.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { test } from 'node:test';
import { createKey, embed } from 'quadmark';
import { generate } from 'quadmark/lab';
import { servePage } from '../web/serve.mjs';
import { openChromium } from './support/chromium.mjs';
import { repository } from './support/files.mjs';
import { noFirefox, startFirefox } from './support/firefox.mjs';
import { FirefoxPage, openFirefoxPage } from './support/firefox_page.mjs';
import { logo } from './support/marks.mjs';

export const pageRoot = join(repository, 'web/dist');
/** Pictures and papers of each state, for the eye. */
export const screenshots = join(repository, 'build/screenshots');

const VIEWPORT = { width: 1280, height: 860 };

async function serve(after) {
  assert.ok(existsSync(join(pageRoot, 'index.html')), 'the page is not built: npm run build --workspace web');
  const { server, url } = await servePage({ root: pageRoot });
  after(() => {
    server.close();
    server.closeAllConnections();
  });
  return url;
}

/** Starts server and Chromium for one test file; both end with its tests. `after` is node:test's. */
export async function startBrowser(after, { serviceWorkers = 'block', viewport = VIEWPORT } = {}) {
  const url = await serve(after);
  const context = await openChromium({ after }, { webgl: true, viewport, acceptDownloads: true, serviceWorkers });
  return { name: 'Chromium', context, url };
}

/**
 * Starts server, Chromium and Firefox for one test file.
 * @return {{ inEach, inChromium }}  make tests of both browsers, or of one: (name, async (t, browser) => ...)
 */
export async function startBrowsers(after, options) {
  const [chromium, firefox] = await Promise.all([startBrowser(after, options), noFirefox ? null : startFirefox(after, options)]);
  const inChromium = (name, body) => test(name, (t) => body(t, chromium));
  const inEach = (name, body) => {
    inChromium(`${name} (Chromium)`, body);
    test(`${name} (Firefox)`, { skip: noFirefox }, (t) => body(t, { name: 'Firefox', firefox, url: chromium.url }));
  };
  return { inEach, inChromium };
}

/**
 * Opens the page in a tab that goes when the test `t` ends. `seen.trouble` collects console errors and warnings,
 * exceptions, violations of the policy and failed requests; `seen.requests` every URL asked for, workers included.
 */
export async function openPage(t, { context, firefox, url }, { path = '' } = {}) {
  const seen = { trouble: [], requests: [], headers: new Map() };
  if (firefox) return { page: await openFirefoxPage(t, firefox, url + path, seen, VIEWPORT), seen };
  const page = await context.newPage();
  page.on('console', (message) => {
    // Said by the test's own tool where a test wants no service worker.
    if (message.text() === 'Service Worker registration blocked by Playwright') return;
    if (['error', 'warning'].includes(message.type())) seen.trouble.push(`console: ${message.text()}`);
  });
  // Choosers are caught from here on: begun only when one is expected, a slow machine may open it before that.
  page.on('filechooser', () => {});
  page.on('pageerror', (error) => seen.trouble.push(`exception: ${error.message}`));
  page.on('requestfailed', (request) => {
    const reason = request.failure()?.errorText;
    // A reload breaks off what was still on its way; that is the test's doing, not the page's.
    if (reason !== 'net::ERR_ABORTED') seen.trouble.push(`failed: ${request.url()} ${reason}`);
  });
  const onRequest = (request) => seen.requests.push(request.url());
  const onResponse = (response) => {
    seen.headers.set(response.url(), response.headers());
    if (response.status() >= 400) seen.trouble.push(`HTTP ${response.status()}: ${response.url()}`);
  };
  // From the context, for requests of workers come from no page.
  context.on('request', onRequest);
  context.on('response', onResponse);
  await page.addInitScript(() => {
    addEventListener('securitypolicyviolation', (event) => console.error(`policy violated: ${event.violatedDirective} ${event.blockedURI}`));
  });
  t.after(async () => {
    context.off('request', onRequest);
    context.off('response', onResponse);
    await page.close();
  });
  await page.goto(url + path, { waitUntil: 'load' });
  return { page, seen };
}

/** Fails when the page did anything it must not: errors, warnings, or a request to another origin than its own. */
export function assertQuiet(seen, url) {
  assert.deepEqual(seen.trouble, []);
  const origin = new URL(url).origin;
  const isOwn = (request) => request.startsWith(`${origin}/`) || request.startsWith(`blob:${origin}/`) || request.startsWith('data:');
  assert.deepEqual(seen.requests.filter((request) => !isOwn(request)), []);
}

/** Waits until the 3D view below `id` draws or says why not; returns "ready" or "failed". */
export async function waitForView(page, id = 'view') {
  await page.locator(`#${id}`).scrollIntoViewIfNeeded();
  await page.waitForFunction((name) => ['ready', 'failed'].includes(document.getElementById(name).dataset.state), id, { timeout: 60000 });
  return page.locator(`#${id}`).getAttribute('data-state');
}

/** Writes { name: bytes } into a fresh folder of the test and returns { folder, paths }. */
export function onDisk(t, files) {
  const folder = mkdtempSync(join(tmpdir(), 'quadmark-drop-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const paths = Object.entries(files).map(([name, bytes]) => {
    const path = join(folder, name);
    mkdirSync(dirname(path), { recursive: true });
    writeFileSync(path, typeof bytes === 'string' || ArrayBuffer.isView(bytes) ? bytes : JSON.stringify(bytes));
    return path;
  });
  return { folder, paths };
}

/**
 * Drops files or folders of the disk onto the middle of the page, through the browser itself.
 * @param hanging  called while they hang over the page; then they are taken away again (Chromium: stay there)
 */
export async function drop(page, paths, { hanging } = {}) {
  if (page instanceof FirefoxPage) {
    await page.dropFiles(paths, { hanging });
    return;
  }
  const session = await page.context().newCDPSession(page);
  const { width, height } = page.viewportSize();
  const event = { x: width / 2, y: height / 2, data: { items: [], files: paths, dragOperationsMask: 1 } };
  await session.send('Input.dispatchDragEvent', { ...event, type: 'dragEnter' });
  await session.send('Input.dispatchDragEvent', { ...event, type: 'dragOver' });
  if (hanging) await hanging();  // the debugger cannot take them away again
  else await session.send('Input.dispatchDragEvent', { ...event, type: 'drop' });
  await session.detach();
}

/** Waits until the page shows one of `states` (match, none, inconclusive, problem, missing, idle). */
export async function waitFor(page, ...states) {
  await page.waitForFunction((wanted) => wanted.includes(document.getElementById('outcome').dataset.state), states, { timeout: 120000 })
    .catch(async (error) => {
      const state = await page.locator('#outcome').getAttribute('data-state');
      const text = await page.locator('#outcome').innerText();
      throw new Error(`waited for ${states}, the page shows ${state}: ${text}`, { cause: error });
    });
}

/** What a person can read now, by part. */
export async function shown(page) {
  const text = async (id, part = '') => ((await page.locator(`#${id}`).isVisible()) ? (await page.locator(`#${id}${part}`).innerText()).trim() : null);
  return {
    state: await page.locator('#outcome').getAttribute('data-state'),
    verdict: await text('verdict-title'),
    odds: await text('odds', ' [aria-hidden]'),
    spokenOdds: await text('odds', ' .visually-hidden'),
    title: await text('problem-title'),
    problem: await text('problem-text'),
    hint: await text('problem-hint'),
    notices: await page.locator('#notices li').allInnerTexts(),
  };
}

/** Grey levels of a picture as the browser decoded it: { width, height, levels }. */
export function picture(page, id) {
  return page.evaluate(async (name) => {
    const image = document.getElementById(name);
    await image.decode();
    const canvas = document.createElement('canvas');
    canvas.width = image.naturalWidth;
    canvas.height = image.naturalHeight;
    const drawing = canvas.getContext('2d');
    drawing.drawImage(image, 0, 0);
    const { data } = drawing.getImageData(0, 0, canvas.width, canvas.height);
    return { width: canvas.width, height: canvas.height, levels: Array.from({ length: data.length / 4 }, (_, i) => data[4 * i]) };
  }, id);
}

/** Fails unless the extracted picture on the page is `image`, bit by bit. */
export async function assertPicture(page, image) {
  const { width, height, levels } = await picture(page, 'image');
  assert.deepEqual([width, height], [image.width, image.height]);
  assert.deepEqual(levels, Array.from(image.bits, (bit) => (bit ? 0 : 255)));
}

/** Two fingers on the screen go apart from `gap` to `wider` pixels around a place. */
export async function spreadFingers(page, [x, y], gap, wider) {
  if (page instanceof FirefoxPage) {
    await page.spreadFingers([x, y], gap, wider);
    return;
  }
  const session = await page.context().newCDPSession(page);
  const fingers = (apart) => [{ x: x - apart / 2, y, id: 1 }, { x: x + apart / 2, y, id: 2 }];
  await session.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: fingers(gap) });
  for (let i = 1; i <= 6; ++i) await session.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: fingers(gap + (wider - gap) * i / 6) });
  await session.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  await session.detach();
}

/** Clicks a link that downloads; { name, bytes } of the file. */
export async function save(page, selector) {
  if (page instanceof FirefoxPage) return page.save(selector);
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator(selector).click()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

/** Leaves <name>.png for the eye. */
export async function screenshot(page, name, options = {}) {
  mkdirSync(screenshots, { recursive: true });
  const file = page instanceof FirefoxPage ? `firefox-${name}.png` : `${name}.png`;
  await page.screenshot({ path: join(screenshots, file), fullPage: true, ...options });
}

/** { model, marked, key, image } of a generated sculpture in `format`. */
export async function markedSculpture({ format = 'glb', vertices = 6000, owner = 'the tests' } = {}) {
  const image = logo();
  const key = await createKey({ owner, width: image.width, height: image.height });
  const { bytes: model } = await generate({ name: 'sculpture', vertices, format });
  const { bytes: marked } = await embed(model, { key, image });
  return { model, marked, key, image };
}
