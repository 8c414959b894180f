// SPDX-License-Identifier: MIT
// Makes the README's pictures of the page, docs/images/page*.png, from the samples. Run by hand when the page changes:
//   npm run build --workspace web && node js_tests/page_pictures.mjs
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { deflateSync, inflateSync } from 'node:zlib';
import { startBrowser, waitFor } from './page_helpers.mjs';
import { repository } from './support/files.mjs';
import { chunk, SIGNATURE } from './support/png.mjs';

const PICTURES = [
  { name: 'page.png', sample: 'damaged', state: 'match', colorScheme: 'light', width: 1040 },
  { name: 'page-dark.png', sample: 'marked', state: 'match', colorScheme: 'dark', width: 1040 },
  { name: 'page-none.png', sample: 'unmarked', state: 'none', colorScheme: 'light', width: 1040 },
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

/** The same picture with at most 256 colours: text on flat ground needs no more, and takes a quarter of the bytes. */
function encode({ width, height, rgb }) {
  const count = new Map();
  for (let i = 0; i < rgb.length; i += 3) {
    const colour = rgb.readUIntBE(i, 3);
    count.set(colour, (count.get(colour) ?? 0) + 1);
  }
  const palette = [...count].sort((a, b) => b[1] - a[1] || a[0] - b[0]).slice(0, 256).map(([colour]) => colour);
  const parts = (colour) => [colour >> 16, (colour >> 8) & 255, colour & 255];
  const nearest = new Map(palette.map((colour, index) => [colour, index]));
  const find = (colour) => {
    if (!nearest.has(colour)) {
      const [r, g, b] = parts(colour);
      const distance = (other) => parts(other).reduce((sum, v, i) => sum + (v - [r, g, b][i]) ** 2, 0);
      nearest.set(colour, palette.reduce((best, other, i) => (distance(other) < distance(palette[best]) ? i : best), 0));
    }
    return nearest.get(colour);
  };
  const rows = Buffer.alloc(height * (width + 1));
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) rows[y * (width + 1) + 1 + x] = find(rgb.readUIntBE((y * width + x) * 3, 3));
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
  for (const { name, sample, state, colorScheme, width } of PICTURES) {
    const page = await context.newPage();
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width, height: 700 });
    await page.goto(url);
    await page.locator(`[data-sample="${sample}"]`).click();
    await waitFor(page, state);
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
