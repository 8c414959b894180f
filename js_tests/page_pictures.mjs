// SPDX-License-Identifier: MIT
// Makes the README's pictures of the page, docs/images/page*.png, from the samples. Run by hand when the page changes:
//   npm run build --workspace web && node js_tests/page_pictures.mjs
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { deflateSync, inflateSync } from 'node:zlib';
import { startBrowser, waitFor, waitForView } from './page_helpers.mjs';
import { repository } from './support/files.mjs';
import { chunk, SIGNATURE } from './support/png.mjs';

const verify = (sample, state) => async (page) => {
  await page.locator(`[data-sample="${sample}"]`).click();
  await waitFor(page, state);
  await waitForView(page);
};

/** Hides the emblem in the unmarked sample and shows what moved. */
async function mark(page) {
  await page.locator('#tab-mark').click();
  await page.locator('#mark-model-input').setInputFiles(join(samples, 'unmarked.glb'));
  await page.locator('#logo-input').setInputFiles(join(samples, 'logo.png'));
  await page.locator('#owner-input').fill('Example Studio');
  await page.locator('#mark-button:enabled').click();
  await page.waitForFunction(() => document.getElementById('mark-outcome').dataset.state === 'done');
  await waitForView(page, 'compare');
  await page.locator('#compare label').nth(1).click();
}

const samples = join(repository, 'web/samples');
const PICTURES = [
  { name: 'page.png', show: verify('damaged', 'match'), width: 1040 },
  { name: 'page-mark.png', show: mark, width: 1040 },
  { name: 'page-none.png', show: verify('wrong', 'none'), colorScheme: 'dark', width: 1040 },
  { name: 'page-phone.png', show: verify('marked', 'match'), language: 'de', width: 390 },
];

/** Pixels of a browser's screenshot, 8-bit RGB or RGBA without interlacing, as RGB. */
function decode(png) {
  let at = 8, width, height, channels;
  const data = [];
  while (at < png.length) {
    const length = png.readUInt32BE(at), type = png.toString('latin1', at + 4, at + 8), body = png.subarray(at + 8, at + 8 + length);
    if (type === 'IHDR') [width, height, channels] = [body.readUInt32BE(0), body.readUInt32BE(4), body[9] === 6 ? 4 : 3];
    if (type === 'IDAT') data.push(body);
    at += length + 12;
  }
  const rows = inflateSync(Buffer.concat(data)), stride = width * channels, rgb = Buffer.alloc(width * height * 3);
  let above = Buffer.alloc(stride);
  for (let y = 0; y < height; ++y) {
    const filter = rows[y * (stride + 1)], row = rows.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1));
    for (let x = 0; x < stride; ++x) {
      const a = x >= channels ? row[x - channels] : 0, b = above[x], c = x >= channels ? above[x - channels] : 0;
      const p = a + b - c, da = Math.abs(p - a), db = Math.abs(p - b), dc = Math.abs(p - c);
      row[x] += [0, a, b, (a + b) >> 1, da <= db && da <= dc ? a : db <= dc ? b : c][filter];
    }
    for (let x = 0; x < width; ++x) row.copy(rgb, (y * width + x) * 3, x * channels, x * channels + 3);
    above = row;
  }
  return { width, height, rgb };
}

const parts = (colour) => [colour >> 16, (colour >> 8) & 255, colour & 255];

/** Colours as [colour, count] in up to `most` boxes of like ones: the largest box is cut in its middle, again and again. */
function boxesOf(colours, most) {
  const measure = (members) => {
    const spans = [0, 1, 2].map((c) => {
      const values = members.map(([colour]) => parts(colour)[c]);
      return values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b));
    });
    const widest = spans.indexOf(Math.max(...spans));
    return { members, widest, size: spans[widest] * Math.sqrt(members.reduce((sum, [, count]) => sum + count, 0)) };
  };
  const boxes = [measure(colours)];
  while (boxes.length < most) {
    const largest = boxes.reduce((best, box) => (box.size > best.size ? box : best));
    if (largest.size === 0) break;
    const sorted = largest.members.toSorted((a, b) => parts(a[0])[largest.widest] - parts(b[0])[largest.widest] || a[0] - b[0]);
    const half = sorted.reduce((sum, [, count]) => sum + count, 0) / 2;
    let cut = 0, below = 0;
    while (cut < sorted.length - 1 && below < half) below += sorted[cut++][1];
    boxes.splice(boxes.indexOf(largest), 1, measure(sorted.slice(0, cut)), measure(sorted.slice(cut)));
  }
  return boxes.map(({ members }) => members);
}

/** The same picture with at most 256 colours, which takes a third of the bytes. */
function encode({ width, height, rgb }) {
  const count = new Map();
  for (let i = 0; i < rgb.length; i += 3) {
    const colour = rgb.readUIntBE(i, 3);
    count.set(colour, (count.get(colour) ?? 0) + 1);
  }
  const nearest = new Map();
  // A box is shown by its commonest colour, so that flat grounds keep theirs.
  const palette = boxesOf([...count], 256).map((members, index) => {
    for (const [colour] of members) nearest.set(colour, index);
    return members.reduce((best, entry) => (entry[1] > best[1] ? entry : best))[0];
  });
  const rows = Buffer.alloc(height * (width + 1));
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) rows[y * (width + 1) + 1 + x] = nearest.get(rgb.readUIntBE((y * width + x) * 3, 3));
  }
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 3], 8);  // 8 bits, palette
  return Buffer.concat([SIGNATURE, chunk('IHDR', header), chunk('PLTE', Buffer.from(palette.flatMap(parts))),
    chunk('IDAT', deflateSync(rows, { level: 9, memLevel: 9 })), chunk('IEND', Buffer.alloc(0))]);
}

const endings = [];
try {
  const { context, url } = await startBrowser((end) => endings.push(end));
  const folder = join(repository, 'docs/images');
  mkdirSync(folder, { recursive: true });
  for (const { name, show, colorScheme = 'light', language = 'en', width } of PICTURES) {
    const page = await context.newPage();
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width, height: 700 });
    await page.goto(url);
    if (language === 'de') await page.locator('#language').click();
    await show(page);
    await page.waitForTimeout(1500);  // for the drawing to come to rest
    await page.mouse.move(0, 0);
    await page.evaluate(() => document.activeElement.blur());
    const png = encode(decode(await page.screenshot({ fullPage: true })));
    writeFileSync(join(folder, name), png);
    console.log(`docs/images/${name}: ${png.length} bytes`);
    await page.close();
  }
} finally {
  for (const end of endings) await end();
}
