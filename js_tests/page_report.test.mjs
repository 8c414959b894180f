// SPDX-License-Identifier: MIT
// What the page hands out: a report of a versioned shape with the fingerprints of everything it read, and one sheet of paper.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after } from 'node:test';
import { inflateSync } from 'node:zlib';
import Ajv from 'ajv';
import { extract, version } from 'quadmark';
import { drop, markedSculpture, onDisk, openPage, save, screenshots, startBrowsers, waitFor, waitForView } from './page_helpers.mjs';
import { splitGlb } from './support/gltf.mjs';
import { repository } from './support/files.mjs';
import { logoPng } from './support/marks.mjs';

const { inEach } = await startBrowsers(after);
const { marked, key, image } = await markedSculpture();
const schema = JSON.parse(readFileSync(join(repository, 'web/src/report/schema.json')));
const validate = new Ajv({ allErrors: true }).compile(schema);

function assertValid(report) {
  assert.ok(validate(report), JSON.stringify(validate.errors));
}

const print = (name, bytes) => ({ name, bytes: bytes.length, sha256: createHash('sha256').update(bytes).digest('hex') });

inEach('the report holds what was read, with what, when, and what came out', async (t, browser) => {
  const { page } = await openPage(t, browser);
  const { gltf, bin } = splitGlb(marked, 'data.bin');
  const reference = logoPng(image);
  const before = Date.now();
  const keyText = JSON.stringify(key);
  await drop(page, onDisk(t, { 'sculpture.gltf': gltf, 'data.bin': bin, 'key.json': keyText, 'logo.png': reference }).paths);
  await waitFor(page, 'match');
  const { name, bytes } = await save(page, '#save-report');
  assert.equal(name, 'sculpture.report.json');
  const report = JSON.parse(bytes);
  assertValid(report);
  const { report: numbers, verdict, falsePositive } = await extract(gltf, { key, reference, resources: { 'data.bin': bin } });
  assert.deepEqual(report.inputs, {
    model: print('sculpture.gltf', Buffer.from(gltf)), resources: [print('data.bin', Buffer.from(bin))],
    key: { source: 'file', scheme: 'paper', owner: 'the tests', ...print('key.json', Buffer.from(keyText)) }, reference: print('logo.png', reference),
  });
  assert.deepEqual(report.numbers, numbers);
  assert.deepEqual([report.verdict, report.falsePositive, report.tool], [verdict, falsePositive, { name: 'quadmark', version: await version() }]);
  assert.ok(Date.parse(report.made) >= before - 1 && Date.parse(report.made) <= Date.now());
  assert.match(report.caveat, /does not say who marked it first/);
  for (const part of Object.keys(report)) assert.equal(validate({ ...report, [part]: undefined }), false, `${part} is needed`);
  assert.equal(validate({ ...report, quadmarkReport: 2 }), false);
  assert.doesNotMatch(bytes.toString(), new RegExp(key.secret.slice(0, 20).replace(/[+/]/g, '\\$&')), 'the secret is not in it');
});

inEach('the picture can be saved', async (t, browser) => {
  const { page } = await openPage(t, browser);
  await drop(page, onDisk(t, { 'sculpture.glb': marked, 'key.json': key }).paths);
  await waitFor(page, 'match');
  const saved = await save(page, '#save-image');
  assert.equal(saved.name, 'sculpture.mark.png');
  assert.deepEqual(saved.bytes, Buffer.from((await extract(marked, { key })).image.png));
});

/** How many pages a PDF has; Firefox packs what says so. */
function pageCount(pdf) {
  let text = pdf.toString('latin1');
  for (const [, packed] of text.matchAll(/\/ObjStm.*?stream\r?\n(.*?)endstream/gs)) text += inflateSync(Buffer.from(packed, 'latin1')).toString('latin1');
  return text.match(/\/Type\s*\/Page\b(?!s)/g).length;
}

inEach('printed, it is one sheet with the verdict, the view, the fingerprints and the caveat', async (t, browser) => {
  const { page } = await openPage(t, browser);
  for (const sample of ['damaged', 'unmarked']) {
    await page.locator(`[data-sample="${sample}"]`).click();
    await waitFor(page, sample === 'damaged' ? 'match' : 'none');
    assert.equal(await waitForView(page), 'ready');
    await page.locator('.view-print').waitFor({ state: 'attached' });
    const pdf = await page.pdf({ format: 'A4', preferCSSPageSize: true, printBackground: true });
    mkdirSync(screenshots, { recursive: true });
    writeFileSync(join(screenshots, `report-${sample}-${browser.name}.pdf`), pdf);
    assert.equal(pageCount(pdf), 1, sample);
    if (browser.name === 'Firefox') continue;  // BiDi has no paper on the screen
    await page.emulateMedia({ media: 'print' });
    for (const part of ['#verdict', '#odds-meaning', '#outcome .caveat', '#print-made', '.view-print', '#facts']) {
      assert.ok(await page.locator(part).isVisible(), `${sample}: ${part}`);
    }
    await page.waitForTimeout(500);  // the view, hidden on paper, must not take a picture of nothing
    assert.ok(await page.locator('.view-print').evaluate((picture) => picture.naturalWidth) > 300, `${sample}: the view has its picture`);
    assert.match(await page.locator('#facts').innerText(), /SHA-256 of [a-z]+\.glb\s+[0-9a-f]{64}/);
    for (const part of ['.inputs', '.saves', '.view-stage', '#language']) assert.equal(await page.locator(part).first().isVisible(), false, part);
    await page.screenshot({ path: join(screenshots, `report-${sample}.png`), fullPage: true });
    await page.emulateMedia({ media: null });
  }
});
