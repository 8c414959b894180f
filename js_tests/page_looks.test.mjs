// SPDX-License-Identifier: MIT
// How the page looks: wide and narrow, light and dark. What can be measured is (nothing sticks out, text contrasts,
// verdicts differ without colour); build/screenshots holds the rest for the eye.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { createKey, embed, extract } from 'quadmark';
import { attack, generate } from 'quadmark/lab';
import { assertQuiet, drop, onDisk, openPage, screenshot, startBrowser, waitFor } from './page_helpers.mjs';
import { logo } from './support/marks.mjs';

const browser = await startBrowser(after);
const { bytes: small } = await generate({ name: 'sculpture', vertices: 3000, format: 'glb' });

/** Elements with text of their own whose contrast against the nearest background is below WCAG's AA. */
function lowContrast(page) {
  return page.evaluate(() => {
    const canvas = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
    const rgba = (colour) => {
      canvas.clearRect(0, 0, 1, 1);
      canvas.fillStyle = colour;
      canvas.fillRect(0, 0, 1, 1);
      return [...canvas.getImageData(0, 0, 1, 1).data];
    };
    const luminance = ([r, g, b]) => {
      const [x, y, z] = [r, g, b].map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
      return 0.2126 * x + 0.7152 * y + 0.0722 * z;
    };
    const bad = [];
    for (const element of document.querySelectorAll('body *')) {
      const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
      if (!own || !element.checkVisibility() || element.closest('.visually-hidden, :disabled, svg')) continue;
      let under = element;
      while (under && rgba(getComputedStyle(under).backgroundColor)[3] < 255) under = under.parentElement;
      const back = luminance(rgba(getComputedStyle(under ?? document.documentElement).backgroundColor));
      const front = luminance(rgba(getComputedStyle(element).color));
      const ratio = (Math.max(back, front) + 0.05) / (Math.min(back, front) + 0.05);
      if (ratio < 4.5) bad.push(`${element.tagName} "${element.textContent.trim().slice(0, 40)}": ${ratio.toFixed(2)}`);
    }
    return bad;
  });
}

const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

for (const scheme of ['light', 'dark']) {
  for (const [size, width] of [['wide', 1280], ['tablet', 768], ['phone', 360]]) {
    test(`${scheme}, ${size}: each state fits and can be read`, async (t) => {
      const { page } = await openPage(t, browser);
      await page.emulateMedia({ colorScheme: scheme });
      await page.setViewportSize({ width, height: 860 });
      const check = async (state) => {
        await screenshot(page, `looks-${scheme}-${size}-${state}`);
        assert.deepEqual(await lowContrast(page), [], state);
        assert.ok(await overflow(page) <= 0, `${state}: ${await overflow(page)} pixels stick out`);
      };
      await check('idle');
      await page.locator('[data-sample="damaged"]').click();
      await waitFor(page, 'match');
      await page.locator('#numbers summary').click();
      await check('match');
      await page.locator('[data-sample="unmarked"]').click();
      await waitFor(page, 'none');
      await check('none');
      const name = `a_very_long_name_${'without_a_space_'.repeat(8)}.glb`;
      await drop(page, onDisk(t, { [name]: 'glTF', 'what.xyz': '?' }).paths);
      await waitFor(page, 'problem');
      await check('problem');
      if (size !== 'phone') return;
      await page.locator('#tab-mark').click();
      await page.locator('#mark-model-input').setInputFiles(onDisk(t, { 'small.glb': small }).paths);
      await page.locator('#payload-kinds label', { hasText: 'ID' }).click();
      await page.locator('#id-input').fill('c0ffee');
      await check('mark-ready');
      await page.locator('#mark-button').click();
      await page.waitForFunction(() => document.getElementById('mark-outcome').dataset.state === 'done', null, { timeout: 60000 });
      assert.ok((await page.locator('#mark-verdict').boundingBox()).y < 200, 'the result is in sight');
      await check('mark-done');
    });
  }
}

test('the verdicts differ in words and in sign, not by colour alone', async (t) => {
  const { page, seen: watch } = await openPage(t, browser);
  const key = { ...(await createKey({ width: 24, height: 24 })), secret: Buffer.alloc(32, 'verdicts').toString('base64') };
  const { bytes: model } = await generate({ name: 'sculpture', vertices: 3000, format: 'ply' });
  const { bytes: marked } = await embed(model, { key, image: logo() });
  // Rougher and rougher: between a match and no mark there is doubt.
  const examples = new Map([['match', marked], ['none', model]]);
  for (let seed = 1; seed <= 10 && !examples.has('inconclusive'); ++seed) {
    for (let amount = 1e-5; amount < 1e-4 && !examples.has('inconclusive'); amount *= 1.05) {
      const { bytes } = await attack(marked, { kind: 'noise', amount, seed });
      const { verdict } = await extract(bytes, { key });
      if (verdict === 'inconclusive') examples.set(verdict, bytes);
      if (verdict === 'none') break;
    }
  }
  assert.ok(examples.has('inconclusive'), 'some amount of noise leaves a doubt');
  const told = [];
  for (const [verdict, bytes] of examples) {
    await page.reload();
    await drop(page, onDisk(t, { 'model.ply': bytes, 'key.json': key }).paths);
    await waitFor(page, verdict);
    const sign = await page.locator('#verdict g').evaluateAll((groups) => groups
      .filter((group) => getComputedStyle(group).display !== 'none').map((group) => group.innerHTML).join());
    told.push({ label: await page.locator('#verdict-label').innerText(), title: await page.locator('#verdict-title').innerText(), sign });
    await screenshot(page, `16-verdict-${verdict}`);
  }
  for (const part of ['label', 'title', 'sign']) {
    assert.equal(new Set(told.map((words) => words[part])).size, 3, part);
    for (const words of told) assert.notEqual(words[part], '');
  }
  assertQuiet(watch, browser.url);
});
