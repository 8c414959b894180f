// SPDX-License-Identifier: MIT
// Measures the built page in Chromium: what a first visit fetches, how long a verdict takes after the drop, and how long
// the page's own thread is ever busy.
//   npm run build --workspace web && node bench/page.mjs [--repeat N]      prints a table and writes build/bench/page.json
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { brotliCompressSync, constants } from 'node:zlib';
import { createKey, embed } from 'quadmark';
import { generate } from 'quadmark/lab';
import { drop, onDisk, openPage, pageRoot, startBrowser, waitFor, waitForView } from '../js_tests/page_helpers.mjs';
import { repository } from '../js_tests/support/files.mjs';
import { longestTask, watchLongTasks } from '../js_tests/support/long_tasks.mjs';
import { drawEmblem } from '../scripts/support/emblem.mjs';

const { values: { repeat } } = parseArgs({ options: { repeat: { type: 'string', default: '5' } } });
const MODELS = [[35000, 'glb'], [1e6, 'ply']];

const endings = [];
/** As tests have it: what to do at the end. */
const bench = { after: (end) => endings.push(end) };
const median = (list) => list.toSorted((a, b) => a - b)[list.length >> 1];

function brotli(name) {
  return brotliCompressSync(readFileSync(join(pageRoot, name)), { params: { [constants.BROTLI_PARAM_QUALITY]: 11 } }).length;
}

/** Files of the page that a visit up to the first verdict asks for, with their compressed sizes. */
async function firstLoad(browser, paths) {
  const { page, seen } = await openPage(bench, browser);
  const started = performance.now();
  await drop(page, paths);
  await waitFor(page, 'match');
  const firstVerdict = performance.now() - started;
  const names = [...new Set(seen.requests)].filter((url) => url.startsWith(browser.url)).map((url) => new URL(url).pathname.slice(1) || 'index.html');
  const before = new Set(names);
  await waitForView(page);
  const view = [...new Set(seen.requests)].map((url) => new URL(url).pathname.slice(1)).filter((name) => /\.js$/.test(name) && !before.has(name));
  const sizes = (list) => Object.fromEntries(list.map((name) => [name, brotli(name)]));
  return { files: sizes(names), view: sizes(view), firstVerdict };
}

async function measure(browser, paths) {
  const times = [];
  let busy = 0, drawn = 0;
  for (let i = 0; i < Number(repeat); ++i) {
    const { page } = await openPage(bench, browser);
    await watchLongTasks(page);
    const started = performance.now();
    await drop(page, paths);
    await waitFor(page, 'match');
    times.push(performance.now() - started);
    await waitForView(page);
    drawn = performance.now() - started;
    busy = Math.max(busy, await longestTask(page));
    await page.close();
  }
  return { least: Math.min(...times), median: median(times), busy, drawn };
}

const total = (sizes) => Object.values(sizes).reduce((a, b) => a + b, 0);

try {
  const browser = await startBrowser(bench.after);
  const result = { firstLoad: null, models: {} };
  const key = await createKey({ owner: 'bench' });
  for (const [vertices, format] of MODELS) {
    const model = await generate({ name: 'sculpture', vertices, format });
    const { bytes } = await embed(model.bytes, { key, image: drawEmblem(24) });
    const { paths } = onDisk(bench, { [`model.${format}`]: bytes, 'key.json': key });
    result.firstLoad ??= await firstLoad(browser, paths);
    result.models[`${model.vertices} vertices, ${format}`] = await measure(browser, paths);
  }
  const kilobytes = (bytes) => `${(bytes / 1000).toFixed(1)} kB`;
  console.log(`first load, brotli: ${kilobytes(total(result.firstLoad.files))} (limit 450 kB); the 3D view, later: ${kilobytes(total(result.firstLoad.view))}`);
  for (const [name, size] of Object.entries(result.firstLoad.files)) console.log(`  ${name.padEnd(40)} ${kilobytes(size).padStart(10)}`);
  console.log(`first drop of a visit, 35 000 vertices: verdict after ${result.firstLoad.firstVerdict.toFixed(0)} ms (aim 1500 ms)`);
  for (const [name, { least, median: middle, busy, drawn }] of Object.entries(result.models)) {
    console.log(`${name}: verdict after ${least.toFixed(0)} ms at best, ${middle.toFixed(0)} ms in the middle; drawn after ${drawn.toFixed(0)} ms; `
      + `the page's thread busy for ${busy === 0 ? 'never more than 50' : `at most ${busy.toFixed(0)}`} ms`);
  }
  mkdirSync(join(repository, 'build/bench'), { recursive: true });
  writeFileSync(join(repository, 'build/bench/page.json'), `${JSON.stringify(result, null, 2)}\n`);
} finally {
  for (const end of endings.reverse()) await end();
}
