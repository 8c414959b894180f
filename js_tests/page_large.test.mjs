// SPDX-License-Identifier: MIT
// A model of a million vertices: the page stays free while it is read, searched and drawn. How long the page's own thread
// is ever busy is measured by bench/page.mjs; here only that the work is not done on it.
import assert from 'node:assert/strict';
import { after } from 'node:test';
import { createKey, embed } from 'quadmark';
import { generate } from 'quadmark/lab';
import { assertQuiet, drop, onDisk, openPage, screenshot, startBrowsers, waitFor, waitForView } from './page_helpers.mjs';
import { longestTask, watchLongTasks } from './support/long_tasks.mjs';

const { inEach } = await startBrowsers(after);
const key = await createKey({ owner: 'large' });
const { bytes: model, vertices } = await generate({ name: 'sculpture', vertices: 1e6, format: 'ply' });
const { bytes } = await embed(model, { key, id: 'abcdef' });

inEach('a million vertices are verified and drawn while the page stays free', async (t, browser) => {
  assert.ok(vertices >= 0.99e6);
  const { page, seen } = await openPage(t, browser);
  const { paths } = onDisk(t, { 'large.ply': bytes, 'key.json': key });
  await watchLongTasks(page);
  const started = Date.now();
  await drop(page, paths);
  await waitFor(page, 'match');
  const read = Date.now() - started;
  assert.equal(await page.locator('#id-text').innerText(), '0000000000abcdef');
  assert.equal(await waitForView(page), 'ready');
  await page.locator('.view-print').waitFor({ state: 'attached', timeout: 60000 });
  const worst = await longestTask(page);
  t.diagnostic(`verdict after ${read} ms; the page's thread was busy for at most ${Math.round(worst)} ms at a time`);
  assert.ok(worst < read / 4, `busy for ${worst} ms of ${read} ms`);
  await screenshot(page, '80-large');
  assertQuiet(seen, browser.url);
});
