// SPDX-License-Identifier: MIT
// For everyone: no violation of axe's rules in any state, both languages, focus and live regions, reduced motion, phones.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { generate } from 'quadmark/lab';
import { assertQuiet, drop, markedSculpture, onDisk, openPage, screenshot, startBrowsers, waitFor, waitForView } from './page_helpers.mjs';
import { assertAccessible } from './support/accessible.mjs';
import { logo, logoPng } from './support/marks.mjs';

const { inEach, inChromium } = await startBrowsers(after);
const { model, marked, key } = await markedSculpture();
const roomy = (await generate({ name: 'sculpture', vertices: 20000, format: 'glb' })).bytes;

/** Opens the page as somebody who never chose a language. */
async function openFresh(t, browser) {
  const opened = await openPage(t, browser);
  await opened.page.evaluate(() => localStorage.clear());
  await opened.page.reload();
  return opened;
}

for (const [language, scheme] of [['en', 'light'], ['de', 'dark']]) {
  // Nobody can tell Firefox over BiDi which colours to prefer.
  (scheme === 'light' ? inEach : inChromium)(`axe-core finds nothing in any state (${language}, ${scheme})`, async (t, browser) => {
    const { page, seen } = await openFresh(t, browser);
    if (scheme === 'dark') await page.emulateMedia({ colorScheme: scheme });
    if (language === 'de') await page.locator('#language').click();
    const check = async (name) => {
      await assertAccessible(page, name);
      await screenshot(page, `60-${language}-${name}`);
    };
    await check('idle');
    await page.locator('[data-sample="damaged"]').click();
    await waitFor(page, 'match');
    await waitForView(page);
    await page.locator('#numbers summary').click();
    await check('match');
    await page.locator('[data-sample="unmarked"]').click();
    await waitFor(page, 'none');
    await page.locator('#passphrase summary').click();
    await check('none');
    await drop(page, onDisk(t, { 'a.glb': marked, 'b.glb': model, 'c.glb': marked.subarray(0, 999), 'key.json': key, 'x.xyz': '?' }).paths);
    await page.waitForFunction(() => /^3 (of|von) 3 /.test(document.getElementById('queue-count').textContent), null, { timeout: 60000 });
    await check('queue');
    await page.locator('#queue-rows button').nth(2).click();
    await waitFor(page, 'problem');
    await check('problem');
    await page.locator('#tab-mark').click();
    await drop(page, onDisk(t, { 'a.glb': roomy, 'logo.png': logoPng(logo(16)) }).paths);
    await page.waitForFunction(() => document.getElementById('mark-button').disabled === false);
    await page.locator('#key-kinds label').nth(2).click();
    await check('mark-ready');
    await page.locator('#key-kinds label').nth(0).click();
    await page.locator('#logo-size').fill('12');
    await page.locator('#mark-button').click();
    await page.waitForFunction(() => document.getElementById('mark-outcome').dataset.state === 'done', null, { timeout: 60000 });
    await waitForView(page, 'compare');
    await check('mark-done');
    assertQuiet(seen, browser.url);
  });
}

inEach('the language is kept, and what is shown follows it', async (t, browser) => {
  const { page, seen } = await openFresh(t, browser);
  await page.locator('[data-sample="marked"]').click();
  await waitFor(page, 'match');
  await page.locator('#language').click();
  assert.equal(await page.locator('html').getAttribute('lang'), 'de');
  assert.equal(await page.locator('#verdict-title').innerText(), 'Dieses Modell trägt die Markierung dieses Schlüssels.');
  assert.match(await page.locator('#odds [aria-hidden]').innerText(), /^1 zu 10/);
  assert.equal(await page.title(), 'quadmark: Ist dieses Modell markiert?');
  const left = await page.evaluate(() => document.body.innerText.match(/\b(the|model|key|nothing|choose|file)\b/gi));
  assert.deepEqual(left?.filter((word) => !/^key$/i.test(word)) ?? [], [], 'no English is left');
  await page.reload();
  assert.equal(await page.locator('#check').innerText(), 'Modell prüfen');
  await page.locator('#language').click();
  assert.equal(await page.locator('#check').innerText(), 'Check the model');
  assertQuiet(seen, browser.url);
});

inChromium('who wants less motion gets none', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const animation = () => page.evaluate(() => getComputedStyle(document.getElementById('progress')).animationName);
  await page.evaluate(() => { document.getElementById('progress').dataset.stage = 'search'; });
  assert.equal(await animation(), 'breathe');
  await page.emulateMedia({ reducedMotion: 'reduce' });
  assert.equal(await animation(), 'none');
});

inEach('tabs are tabs: arrows move between them, and links lead to them', async (t, browser) => {
  const { page } = await openPage(t, browser, { path: '#mark' });
  assert.equal(await page.locator('#mark').isVisible(), true);
  assert.equal(await page.locator('#tab-mark').getAttribute('aria-selected'), 'true');
  await page.locator('#tab-mark').focus();
  await page.keyboard.press('ArrowLeft');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'tab-verify');
  assert.equal(await page.locator('#verify').isVisible(), true);
});
