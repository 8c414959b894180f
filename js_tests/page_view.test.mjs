// SPDX-License-Identifier: MIT
// The 3D view: it draws, turns and colours; its readers number vertices as the core does.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import draco3d from 'draco3dgltf';
import { createKey, embed, extract, inspect } from 'quadmark';
import { attack, generate } from 'quadmark/lab';
import { readGeometry } from '../web/src/view3d/geometry/index.js';
import { displacementColours, evidenceColours } from '../web/src/view3d/heat.js';
import { assertQuiet, drop, onDisk, openPage, screenshot, spreadFingers, startBrowsers, waitFor, waitForView } from './page_helpers.mjs';
import { compressGlb, encodeDraco, meshOf } from './support/draco.mjs';
import { allRealModels, readModelFiles } from './support/files.mjs';
import { makeGlb, openGltf } from './support/gltf.mjs';
import { logo } from './support/marks.mjs';

const { inEach, inChromium } = await startBrowsers(after);
const key = await createKey({ owner: 'the view' });
const openDraco = () => draco3d.createDecoderModule();

/** { covered, colours }: share of the stage that shows the model, and mean colour of it. */
function look(page, id = 'view') {
  return page.evaluate(async (name) => {
    const picture = document.querySelector(`#${name} .view-print`);
    await picture.decode();
    const bitmap = await createImageBitmap(picture);
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    canvas.drawImage(bitmap, 0, 0);
    const { data } = canvas.getImageData(0, 0, bitmap.width, bitmap.height);
    let covered = 0, blue = 0, hash = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] < 128) continue;
      ++covered;
      if (data[i + 2] > data[i] + 40) ++blue;
      hash = (hash * 31 + data[i] + (i >> 2)) >>> 0;
    }
    return { covered: covered / (data.length / 4), blue: blue / covered, hash };
  }, id);
}

/** Does something to the view and waits for the next picture of it. */
async function changed(page, act) {
  await page.evaluate(() => { document.querySelector('#view .view-print').dataset.old = document.querySelector('#view .view-print').src; });
  await act();
  await page.waitForFunction(() => {
    const picture = document.querySelector('#view .view-print');
    return picture.src !== picture.dataset.old && picture.complete;
  });
  await page.waitForTimeout(700);  // a later picture of the same change
  return look(page);
}

inEach('nothing below the view moves when it comes', async (t, browser) => {
  for (const [sample, verdict] of [['marked', 'match'], ['unmarked', 'none']]) {
    const { page } = await openPage(t, browser);
    await page.locator(`[data-sample="${sample}"]`).click();
    // In each frame with a result: how far below the top of the view the buttons lie, by what the view does.
    await page.evaluate(() => {
      const view = document.getElementById('view'), saves = document.getElementById('save-report');
      globalThis.distances = [];
      const look = () => {
        const { height, top } = saves.getBoundingClientRect();
        if (height > 0) globalThis.distances.push([view.dataset.state ?? 'waiting', Math.round(top - view.getBoundingClientRect().top)]);
        requestAnimationFrame(look);
      };
      look();
    });
    await waitFor(page, verdict);
    assert.equal(await waitForView(page), 'ready');
    await page.waitForTimeout(200);
    const distances = await page.evaluate(() => globalThis.distances);
    assert.ok(distances.some(([state]) => state !== 'ready') && distances.at(-1)[0] === 'ready', JSON.stringify(distances));
    assert.equal(new Set(distances.map(([, distance]) => distance)).size, 1, `${sample}: ${JSON.stringify(distances)}`);
  }
});

inEach('the model is drawn with its evidence, and turned by mouse, wheel, touch and keys', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  assert.equal(seen.requests.some((url) => /scene-[^/]*\.js$/.test(url)), false, 'three.js waits until it is needed');
  await page.locator('[data-sample="marked"]').click();
  await waitFor(page, 'match');
  assert.equal(await waitForView(page), 'ready');
  await page.locator('.view-print').waitFor({ state: 'attached' });
  const first = await look(page);
  assert.ok(first.covered > 0.1 && first.blue > 0.1, JSON.stringify(first));
  await screenshot(page, '30-view-evidence');
  const canvas = page.locator('#view canvas');
  const box = await canvas.boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const turned = await changed(page, async () => {
    await page.mouse.move(...middle);
    await page.mouse.down();
    await page.mouse.move(middle[0] + 120, middle[1] + 10, { steps: 4 });
    await page.mouse.up();
  });
  assert.notEqual(turned.hash, first.hash);
  const nearer = await changed(page, async () => {
    await canvas.focus();
    await page.keyboard.press('+');
    await page.keyboard.press('ArrowUp');
  });
  assert.ok(nearer.covered > turned.covered * 1.1, 'nearer');
  const wheel = await changed(page, () => page.mouse.wheel(0, 400));
  assert.ok(wheel.covered < nearer.covered, 'the wheel zooms out');
  const touched = await changed(page, () => spreadFingers(page, middle, 80, 200));
  assert.ok(touched.covered > wheel.covered, 'two fingers zoom in');
  const again = await changed(page, () => canvas.press('0'));
  assert.ok(Math.abs(again.covered - first.covered) < 0.002 && Math.abs(again.blue - first.blue) < 0.01, 'back where it began');
  const plain = await changed(page, () => page.locator('#view label', { hasText: 'Plain' }).click());
  assert.equal(plain.blue, 0);
  assert.equal(await page.locator('#view .legend').isVisible(), false);
  await screenshot(page, '31-view-plain');
  assertQuiet(seen, browser.url);
});

inEach('each node has its share of the evidence', async (t, browser) => {
  const { page } = await openPage(t, browser);
  await page.locator('[data-sample="damaged"]').click();
  await waitFor(page, 'match');
  assert.deepEqual(await page.locator('#node-rows tr td:nth-child(2)').allInnerTexts().then((texts) => texts.map((text) => text.trim())), ['100 %']);
  await page.locator('[data-sample="unmarked"]').click();
  await waitFor(page, 'none');
  assert.equal(await page.locator('#nodes').isVisible(), false);
  assert.equal(await waitForView(page), 'ready');
  assert.match(await page.locator('#view').innerText(), /There is no evidence to show/);
});

inChromium('Draco is drawn with its evidence, by a decoder fetched for it; without that decoder it is said', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const { bytes } = await generate({ name: 'sculpture', vertices: 8000, format: 'glb' });
  const marked = Buffer.from((await embed(bytes, { key, id: '1' })).bytes);
  const { positions, indices } = meshOf(marked);
  const files = { 'packed.glb': compressGlb(marked), 'bare.drc': encodeDraco({ POSITION: [positions, 3] }, indices).bytes };
  const isDecoder = (url) => /draco_decoder[^/]*\.(js|wasm)$/.test(url);
  for (const [name, file] of Object.entries(files)) {
    await page.reload();
    seen.requests.length = 0;
    await drop(page, onDisk(t, { [name]: file, 'key.json': key }).paths);
    await waitFor(page, 'match');
    assert.deepEqual(seen.requests.filter(isDecoder), [], 'not for the verdict');
    assert.equal(await waitForView(page), 'ready', name);
    await page.locator('.view-print').waitFor({ state: 'attached' });
    const { covered, blue } = await look(page);
    assert.ok(covered > 0.1 && blue > 0.1, `${name}: ${covered}, ${blue}`);
    assert.equal(seen.requests.filter(isDecoder).length, 2, 'script and wasm');
    await screenshot(page, `32-view-${name.replace('.', '-')}`);
  }
  assertQuiet(seen, browser.url);
  await browser.context.route(/draco_decoder[^/]*\.wasm$/, (route) => route.fulfill({ status: 404, body: 'gone' }));
  t.after(() => browser.context.unroute(/draco_decoder[^/]*\.wasm$/));
  await page.reload();
  await drop(page, onDisk(t, { 'packed.glb': files['packed.glb'], 'key.json': key }).paths);
  await waitFor(page, 'match');
  assert.equal(await waitForView(page), 'failed');
  assert.match(await page.locator('#view').innerText(), /^The model cannot be drawn here: .*\. The verdict does not depend on it\.$/);
});

test('vertices are numbered as the evidence is, for every model', async (t) => {
  const models = allRealModels(t);
  for (const { name, path } of models) {
    const { model, resources } = await readModelFiles(path);
    const report = await inspect(model, { resources });
    const { pieces, vertexCount } = await readGeometry(new Uint8Array(model), async (uri) => new Uint8Array(resources[uri]), openDraco);
    assert.equal(vertexCount, report.vertices, name);
    let corners = 0;
    for (const { triangles, positions, numbers } of pieces) {
      assert.ok(triangles.every((corner) => corner < positions.length / 3), `${name}: corners are vertices`);
      assert.ok(numbers.length === positions.length / 3 && numbers.every((number) => number < vertexCount), `${name}: each has a number`);
      corners += triangles.length;
    }
    assert.ok(corners > 0, name);
  }
  t.diagnostic(`${models.length} real models`);
});

/** A GLB of one primitive with its positions in a sparse accessor: over zeros, or over other positions. */
function sparseGlb(glb, { overZeros }) {
  const { json, bin } = openGltf(glb);
  const { count, positions } = meshOf(glb);
  const accessor = json.accessors[json.meshes[0].primitives[0].attributes.POSITION];
  const replaced = Uint32Array.from({ length: count }, (_, i) => i).filter((i) => overZeros || i % 3 === 0);
  const values = Float32Array.from({ length: 3 * replaced.length }, (_, i) => positions[3 * replaced[Math.floor(i / 3)] + i % 3]);
  const base = positions.map((value, i) => (i % 9 < 3 ? value + 1 : value));
  const parts = [bin];
  const add = (array) => {
    const byteOffset = parts.reduce((sum, part) => sum + part.length, 0);
    parts.push(Buffer.from(array.buffer));
    return json.bufferViews.push({ buffer: 0, byteOffset, byteLength: array.byteLength }) - 1;
  };
  if (overZeros) delete accessor.bufferView;
  else Object.assign(accessor, { bufferView: add(base), byteOffset: 0 });
  accessor.sparse = { count: replaced.length, indices: { bufferView: add(replaced), componentType: 5125 }, values: { bufferView: add(values) } };
  const data = Buffer.concat(parts);
  json.buffers = [{ byteLength: data.length }];
  return makeGlb(json, data);
}

test('evidence lies at the same places however a model is stored: plain, Draco, sparse', async () => {
  const { bytes } = await generate({ name: 'sculpture', vertices: 8000, format: 'glb' });
  const plain = Buffer.from((await embed(bytes, { key, id: '1' })).bytes);
  const { positions, indices } = meshOf(plain);
  const placed = async (file) => {
    const { evidence, verdict } = await extract(file, { key });
    assert.equal(verdict, 'match');
    const { pieces: [piece], vertexCount } = await readGeometry(new Uint8Array(file), null, openDraco);
    assert.equal(vertexCount, evidence.length);
    return Array.from(piece.numbers, (number, i) => `${piece.positions.subarray(3 * i, 3 * i + 3).join()}: ${evidence[number]}`).sort();
  };
  const expected = await placed(plain);
  assert.ok(expected.some((line) => !line.endsWith(': 0')));
  const stored = {
    'Draco in glTF': compressGlb(plain), 'bare Draco': encodeDraco({ POSITION: [positions, 3] }, indices).bytes,
    'sparse over zeros': sparseGlb(plain, { overZeros: true }), 'sparse over others': sparseGlb(plain, { overZeros: false }),
  };
  for (const [how, file] of Object.entries(stored)) assert.deepEqual(await placed(file), expected, how);
});

test('evidence lies where the mark is read', async () => {
  const { bytes } = await generate({ name: 'sculpture', vertices: 20000, format: 'ply' });
  const marked = await embed(bytes, { key, image: logo(16) });
  const reordered = await attack(marked.bytes, { kind: 'reorder', seed: 3, format: 'glb' });
  for (const file of [marked.bytes, reordered.bytes]) {
    const { evidence, report } = await extract(file, { key });
    const { pieces: [piece], vertexCount } = await readGeometry(file, null);
    assert.equal(vertexCount, evidence.length);
    assert.equal(evidence.filter((value) => value !== 0).length, report.cells);
    const colours = evidenceColours(evidence, piece.triangles);
    const voted = evidence.findIndex((value) => value > 0.5);
    assert.ok(colours[3 * voted + 2] > colours[3 * voted] + 60, 'blue where the vote is for the mark');
  }
  assert.deepEqual([...displacementColours(Float32Array.of(0, 1), 1)], [198, 204, 216, 176, 24, 84]);
});

test('PLY of every encoding, strips and polygons', async () => {
  const header = (format, rest) => `ply\nformat ${format} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n${rest}end_header\n`;
  const ascii = header('ascii', 'element face 1\nproperty list uchar int vertex_indices\n') + '0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n';
  const strip = header('ascii', 'element tristrips 1\nproperty list int int vertex_indices\n') + '0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n8 0 1 2 3 -1 0 1 3\n';
  const read = async (text) => (await readGeometry(new TextEncoder().encode(text), null)).pieces[0];
  assert.deepEqual([...(await read(ascii)).triangles], [0, 1, 2, 0, 2, 3]);
  assert.deepEqual([...(await read(strip)).triangles], [0, 1, 2, 2, 1, 3, 0, 1, 3]);
  assert.deepEqual([...(await read(ascii)).positions].slice(3, 9), [1, 0, 0, 1, 1, 0]);
});
