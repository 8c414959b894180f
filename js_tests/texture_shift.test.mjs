// SPDX-License-Identifier: MIT
// How far the report says that textures slide, against a calculation of its own: the scene's texture coordinates are its
// x and y divided by 8, so that a triangle with the normal n maps a displacement d to (d - (d n) n) / 8.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, test } from 'node:test';
import { embed } from 'quadmark';
import { quadmark, temporaryFolder } from './support/files.mjs';
import { readDocument } from './support/gltf_readers.mjs';
import { fixedRobustKey, sculpture } from './support/marks.mjs';
import { webScene } from './support/scenes.mjs';
import { runTool } from './support/tools.mjs';

const PIXELS = 32;  // of the scene's texture, both ways
let scene, key;

before(async () => {
  [scene, key] = [await webScene(9000), await fixedRobustKey()];
});

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The largest shift in texture coordinates; per vertex the mean over its triangles, weighted by their area. */
async function largestShift(original, marked) {
  const meshes = async (bytes) => (await readDocument(bytes)).getRoot().listMeshes().map((mesh) => mesh.listPrimitives()[0]);
  const [was, is] = [await meshes(original), await meshes(marked)];
  let largest = 0;
  was.forEach((primitive, m) => {
    const read = (from, v) => from.getAttribute('POSITION').getElement(v, []);
    const indices = primitive.getIndices().getArray();
    const sums = new Map();
    for (let i = 0; i < indices.length; i += 3) {
      const corners = [...indices.subarray(i, i + 3)];
      const [a, b, c] = corners.map((v) => read(primitive, v));
      const area = cross(b.map((x, k) => x - a[k]), c.map((x, k) => x - a[k]));
      const length = Math.sqrt(dot(area, area));
      if (length === 0) continue;
      const normal = area.map((x) => x / length);
      for (const v of corners) {
        const from = read(primitive, v), d = read(is[m], v).map((x, k) => x - from[k]);
        const sum = sums.get(v) ?? [0, 0, 0];
        for (const axis of [0, 1]) sum[axis] += (length * (d[axis] - dot(d, normal) * normal[axis])) / 8;
        sum[2] += length;
        sums.set(v, sum);
      }
    }
    for (const [u, v, weight] of sums.values()) largest = Math.max(largest, Math.hypot(u, v) / weight);
  });
  return largest;
}

test('the shift of a textured scene is what its geometry says', async () => {
  const { bytes, report } = await embed(scene, { key, id: 'c0ffee' });
  const expected = await largestShift(scene, bytes);
  assert.ok(expected > 0);
  assert.ok(Math.abs(report.textureShift.uv / expected - 1) < 1e-4, `${report.textureShift.uv}, expected ${expected}`);
  assert.ok(Math.abs(report.textureShift.texels / (PIXELS * expected) - 1) < 1e-4);
  assert.match(report.textureShift.place, /^mesh [012] primitive 0$/);
});

test('it shrinks with the largest slide that is allowed', async () => {
  const shiftOf = async (maxSlide) => (await embed(scene, { key, id: 'c0ffee', options: { maxSlide } })).report.textureShift.uv;
  const [loose, tight] = [await shiftOf(0.004), await shiftOf(0.001)];
  assert.ok(tight < loose, `${tight}, ${loose}`);
});

for (const tool of ['gltf-transform quantize', 'gltf-transform meshopt', 'gltf-transform draco', 'gltfpack -cc -kn']) {
  test(`it is known for the same scene after ${tool}`, async () => {
    const { report } = await embed(await runTool(tool, scene), { key, id: 'c0ffee' });
    const { uv, texels } = report.textureShift;
    assert.ok(uv > 1e-4 && uv < 0.01, `${uv}`);
    assert.ok(Math.abs(texels / (PIXELS * uv) - 1) < 1e-9);
  });
}

test('it is null without textures, and the command line shows it where there are some', async (t) => {
  const folder = temporaryFolder(t);
  const bare = await sculpture('glb', 9000);
  assert.equal((await embed(bare, { key, id: 'c0ffee' })).report.textureShift, null);
  writeFileSync(join(folder, 'scene.glb'), scene);
  writeFileSync(join(folder, 'bare.glb'), bare);
  writeFileSync(join(folder, 'key.json'), JSON.stringify(key));
  const cli = (name) => quadmark(['embed', name, 'out.glb', '--key', 'key.json', '--id', 'c0ffee', '--force'], { cwd: folder });
  assert.match((await cli('scene.glb')).stdout.toString(), /textures slide by [\d.]+ texels at most \(mesh \d primitive 0; --max-slide limits it\)/);
  assert.doesNotMatch((await cli('bare.glb')).stdout.toString(), /textures slide/);
});
