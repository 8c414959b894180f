// SPDX-License-Identifier: MIT
// The report of the evaluation, of rows made up here: its plots hold the points of the rows, its tables every cell with its
// count, and the page is one that anybody can read.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { recordedContext } from '../bench/evaluation/context.mjs';
import { ChanceRows } from '../bench/evaluation/chance_rows.mjs';
import { writeReport } from '../bench/evaluation/report.mjs';
import { curveSpec } from '../bench/evaluation/report/curves.mjs';
import { plot } from '../bench/evaluation/report/plot.mjs';
import { entry, summarize } from '../bench/evaluation/report/statistics.mjs';
import { Rows } from '../bench/evaluation/rows.mjs';
import { noChromium, openChromium } from './support/chromium.mjs';
import { temporaryFolder } from './support/files.mjs';
import { assertAccessible } from './support/accessible.mjs';

const MODEL = 'sculpture:8000:1';
const peer = { authors: 'A. Body', title: 'A mark & a <test>', venue: 'Journal', year: 2001, blind: true, carrier: 'a bin', settings: 'strength 0.01 .. 0.2, usually 0.04', decided: 'nothing', validation: 'a figure' };
const schemes = [{ name: 'robust', usualSettings: 'standard' }, { name: 'paper', usualSettings: 'L=2' }, { name: 'cho-mean', usualSettings: 'strength=0.04', peer }];

/** A folder of results with a few rows of most kinds. */
function results(t) {
  const folder = temporaryFolder(t), rows = new Rows(join(folder, 'readings.csv'));
  const mark = { outcome: 'written', vertices: 8000, capacity: 2000, carriers: 500, hausdorff: 8e-4, rms: 1.5e-4, max: 3e-3, snr: 50, psnr: 48, normals: 0.4, msdm2: 0.11 };
  const add = (scheme, settings, payload, attack, ...readings) => readings.forEach((reading, i) =>
    rows.add({ scheme, settings, payload, model: MODEL, seed: i + 1, attack, ...reading }));
  const read = (ber) => ({ outcome: ber === 0 ? 'exact' : 'lost', ber, unread: 0, claim: ber === 0 ? 1e-20 : 0.3 });
  for (const settings of ['invisible', 'standard', 'strong']) add('robust', settings, 'id', 'mark', { ...mark, rms: { invisible: 5e-5, standard: 1.5e-4, strong: 1e-3 }[settings] });
  for (const [i, settings] of ['L=2', 'L=3', 'L=4'].entries()) add('paper', settings, 'id', 'mark', { ...mark, rms: 1.5e-4 / (i + 1) });
  for (const strength of ['0.16', '0.04', '0.01']) add('cho-mean', `strength=${strength}`, 'id', 'mark', { outcome: 'refused', note: 'too few "vertices"' });
  add('robust', 'standard', 'id', 'liris-noise:0.001', read(0), read(0), read(0));
  add('robust', 'standard', 'id', 'liris-noise:0.003', read(0), read(0.5), read(0.5));
  add('paper', 'L=2', 'id', 'liris-noise:0.001', read(0.125), read(0.25), read(0.375), read(0.5));
  add('paper', 'L=2', 'image:24', 'noise:1e-5', read(0.0625), read(0.1875));
  add('robust', 'standard', 'id', 'tool:gltfpack -cc', read(0), read(0.5));
  add('paper', 'L=2', 'id', 'tool:gltfpack -cc', { outcome: 'failed', note: 'gltfpack is not installed' });
  const chance = new ChanceRows(join(folder, 'chance.csv'));
  const cell = { scheme: 'robust', settings: 'standard', kind: 'unmarked', model: 'sculpture:3000:1' };
  chance.add(cell, { 0: { trials: 900, matches: 0 }, 10: { trials: 90, matches: 0 }, 20: { trials: 10, matches: 0 } });
  chance.refuse({ ...cell, kind: 'wrong-key' }, 'no room');
  chance.save();
  writeFileSync(join(folder, 'machine.json'), JSON.stringify({
    date: '2026-01-02', commit: 'abcdef', cpu: 'a processor', cores: 2, memoryGiB: 8, system: 'Debian', compiler: 'g++', node: '20', quadmark: '0.1.0', schemes, tools: { gltfpack: '1.0' },
  }));
  return recordedContext(folder, { quick: true });
}

async function reportOf(t) {
  const context = results(t), file = join(context.folder, 'report.html');
  await writeReport(file, context);
  return { file, html: readFileSync(file, 'utf8').replaceAll('\u00a0', ' ') };
}

const sectionOf = (html, id) => new RegExp(`<section id="${id}"[\\s\\S]*?</section>`).exec(html)[0];
const rowOf = (html, name) => new RegExp(`<tr><th scope="row">${name}</th>(.*?)</tr>`).exec(html)[1].replace(/<\/td><td>/g, ' | ').replace(/<\/?td>/g, '');

test('medians and quartiles are those of the values, and cells say how many there are or why there are none', () => {
  assert.deepEqual(summarize([4, 1, 3, 2]), { median: 2.5, low: 1.75, high: 3.25, trials: 4 });
  assert.equal(summarize([]), null);
  assert.equal(entry(summarize([0.1, 0.2]), []), '15\u00a0% (2)');
  assert.equal(entry(null, []), 'not measured');
  assert.equal(entry(null, [{ outcome: 'failed', note: 'not installed' }, { outcome: 'failed', note: 'not installed' }]), 'failed: not installed');
});

test('a plot has one point per cell at its median, in the colours of the page', async () => {
  const points = [0, 0.1, 0.4].map((median, i) => ({ x: `${i}`, series: 'a', median, low: median, high: median, trials: 3 }));
  const svg = await plot(curveSpec({ points, order: ['0', '1', '2'], series: ['a', 'b'], xTitle: 'step' }), 'three <points>');
  assert.match(svg, /^<svg role="img" aria-label="three &lt;points&gt;"/);
  const places = [...svg.matchAll(/<path transform="translate\(([\d.]+),([\d.]+)\)" d="M[^"]*" fill="var\(--series-0\)"/g)].map(([, x, y]) => [Number(x), Number(y)]);
  assert.equal(places.length, 3);
  assert.ok(places[0][0] < places[1][0] && places[1][0] < places[2][0], JSON.stringify(places));
  const [zero, tenth, rest] = places.map(([, y]) => y);
  assert.ok(Math.abs((zero - rest) / (zero - tenth) - 4) < 0.05, `heights ${places}`);
  assert.doesNotMatch(svg, /="#|rgb\(/);
});

test('the report shows every cell with its count, and says why others are empty', async (t) => {
  const { html } = await reportOf(t);
  const liris = sectionOf(html, 'liris');
  assert.equal(rowOf(liris, 'noise 0.1 %'), '0 % (3) | 31.3 % (4) | not measured');
  assert.equal(rowOf(liris, 'noise 0.3 %'), '50 % (3) | not measured | not measured');
  assert.match(liris, /aria-label="Noise: robust at 0.1 %: 0 %; paper at 0.1 %: 31.3 %; robust at 0.3 %: 50 %"/);
  assert.equal(rowOf(sectionOf(html, 'attacks'), 'noise 1e-5'), 'not measured | 12.5 % (2)');
  assert.equal(rowOf(sectionOf(html, 'tools'), 'gltfpack -cc'), '1 / 2 | failed: gltfpack is not installed');
  assert.equal(rowOf(sectionOf(html, 'distortion'), 'robust standard'), '1.5e-4 (1)');
  const chance = sectionOf(html, 'chance');
  assert.equal(rowOf(chance, 'robust, unmarked'), '1000 | 0.10 | 0.10 | 0.010 | 0 | 0 | 0 | 1.0e-2 | 1.0');
  assert.ok(rowOf(chance, 'robust, marked, wrong key').startsWith('sculpture:3000:1: no room'));
  assert.match(sectionOf(html, 'schemes'), /A mark &amp; a &lt;test&gt;/);
});

test('the report is one file without scripts, and each of its pictures says what it shows', async (t) => {
  const { html } = await reportOf(t);
  assert.doesNotMatch(html.replace(/base64,[^"]*/g, ''), /<script|<link|https?:\/\/(?!www\.w3\.org\/2000\/svg)|undefined|NaN|\[object/);
  for (const [svg] of html.matchAll(/<svg [^>]*>/g)) assert.match(svg, /aria-label="[^"]+"|aria-hidden="true"/);
  for (const [image] of html.matchAll(/<img [^>]*>/g)) assert.match(image, /src="data:.* alt="[^"]+"/);
});

test('the report fits phones and desks, light, dark and on paper, and breaks no rule of axe', { skip: noChromium }, async (t) => {
  const { file } = await reportOf(t);
  const page = await (await openChromium(t)).newPage();
  for (const [width, colorScheme] of [[360, 'dark'], [1280, 'light']]) {
    await page.setViewportSize({ width, height: 800 });
    await page.emulateMedia({ colorScheme, media: 'screen' });
    await page.goto(`file://${file}`);
    const over = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert.ok(over <= 0, `${over} pixels too wide at ${width}`);
    await assertAccessible(page, `${width} pixels, ${colorScheme}`);
  }
  await page.emulateMedia({ media: 'print' });
  // The numbers are printed, too. The browser finds out what is visible when it next draws.
  await page.waitForFunction(() => document.querySelector('details table').checkVisibility({ contentVisibilityAuto: true }));
});
