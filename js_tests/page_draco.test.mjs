// SPDX-License-Identifier: MIT
// The page fetches the module with Draco's decoder for the models that need it, and for no others.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { assertPicture, assertQuiet, drop, markedSculpture, onDisk, openPage, startBrowsers, waitFor } from './page_helpers.mjs';
import { compressGlb, encodeDraco, meshOf } from './support/draco.mjs';

const { inEach } = await startBrowsers(after);
const { marked, key, image } = await markedSculpture();
const compressed = compressGlb(Buffer.from(marked));
const { positions, indices } = meshOf(marked);
const bare = encodeDraco({ POSITION: [positions, 3] }, indices).bytes;

const isDraco = (url) => /quadmark_draco[^/]*\.(js|wasm)$/.test(url);

inEach('a plain model is checked without Draco', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  await drop(page, onDisk(t, { 'sculpture.glb': marked, 'key.json': key }).paths);
  await waitFor(page, 'match');
  assert.deepEqual(seen.requests.filter(isDraco), []);
  assertQuiet(seen, browser.url);
});

for (const [name, bytes] of [['sculpture.glb', compressed], ['sculpture.drc', bare]]) {
  inEach(`Draco's decoder is fetched for a ${name.slice(-4)} that needs it, under the page's policy`, async (t, browser) => {
    const { page, seen } = await openPage(t, browser);
    await drop(page, onDisk(t, { [name]: bytes, 'key.json': key }).paths);
    await waitFor(page, 'match');
    await assertPicture(page, image);
    assert.deepEqual(seen.requests.filter(isDraco).map((url) => url.slice(url.lastIndexOf('.'))).sort(), ['.js', '.wasm']);
    assertQuiet(seen, browser.url);
  });
}
