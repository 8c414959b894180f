// SPDX-License-Identifier: MIT
// The built page in a real Chromium: served under its policy, watched for anything it must not do, and used as a
// person does (files dropped through the browser's own drag and drop, buttons, keys).
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { chromium } from 'playwright-core';
import { createKey, embed } from 'quadmark';
import { generate } from 'quadmark/lab';
import { servePage } from '../web/serve.mjs';
import { repository } from './support/files.mjs';
import { logo } from './support/marks.mjs';

export const pageRoot = join(repository, 'web/dist');
/** Pictures and papers of each state, for the eye. */
export const screenshots = join(repository, 'build/screenshots');

/** Starts server and browser for one test file; both end with its tests. `after` is node:test's. */
export async function startBrowser(after, { serviceWorkers = 'block', viewport = { width: 1280, height: 860 } } = {}) {
  assert.ok(existsSync(join(pageRoot, 'index.html')), 'the page is not built: npm run build --workspace web');
  const { server, url } = await servePage({ root: pageRoot });
  const profile = mkdtempSync(join(tmpdir(), 'quadmark-chromium-'));
  let context;
  after(async () => {
    await context?.close();
    server.close();
    server.closeAllConnections();
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  });
  context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.QUADMARK_CHROMIUM || '/usr/bin/chromium',
    headless: true,
    viewport,
    acceptDownloads: true,
    serviceWorkers,
    args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
      '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  return { context, url };
}

/**
 * Opens the page in a tab that goes when the test `t` ends. `seen.trouble` collects console errors and warnings,
 * exceptions, violations of the policy and failed requests; `seen.requests` every URL asked for, workers included.
 */
export async function openPage(t, { context, url }, { path = '' } = {}) {
  const page = await context.newPage();
  const seen = { trouble: [], requests: [], headers: new Map() };
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
  assert.deepEqual(seen.requests.filter((request) => !request.startsWith(`${origin}/`) && !request.startsWith(`blob:${origin}/`)), []);
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

/** Drops files or folders of the disk onto the middle of the page, through the browser itself. */
export async function drop(page, paths, { leave = false } = {}) {
  const session = await page.context().newCDPSession(page);
  const { width, height } = page.viewportSize();
  const event = { x: width / 2, y: height / 2, data: { items: [], files: paths, dragOperationsMask: 1 } };
  await session.send('Input.dispatchDragEvent', { ...event, type: 'dragEnter' });
  await session.send('Input.dispatchDragEvent', { ...event, type: 'dragOver' });
  if (!leave) await session.send('Input.dispatchDragEvent', { ...event, type: 'drop' });
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

/** Clicks a link that downloads; { name, bytes } of the file. */
export async function save(page, selector) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator(selector).click()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

/** Leaves <name>.png for the eye. */
export async function screenshot(page, name, options = {}) {
  mkdirSync(screenshots, { recursive: true });
  await page.screenshot({ path: join(screenshots, `${name}.png`), fullPage: true, ...options });
}

/** { model, marked, key, image } of a generated sculpture in `format`. */
export async function markedSculpture({ format = 'glb', vertices = 6000, owner = 'the tests' } = {}) {
  const image = logo();
  const key = await createKey({ owner, width: image.width, height: image.height });
  const { bytes: model } = await generate({ name: 'sculpture', vertices, format });
  const { bytes: marked } = await embed(model, { key, image });
  return { model, marked, key, image };
}
