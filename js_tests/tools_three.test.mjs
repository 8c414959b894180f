// SPDX-License-Identifier: MIT
// three.js in Chromium: GLTFExporter reads what we write and we what it writes; what we mark looks as it did.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { embed } from 'quadmark';
import { noChromium } from './support/chromium.mjs';
import { assertLooksTheSame } from './support/looks.mjs';
import { fixedKey, logo } from './support/marks.mjs';
import { assertRoundTrip } from './support/round_trip.mjs';
import { webScene } from './support/scenes.mjs';
import { openThree } from './support/three.mjs';
import { runTool } from './support/tools.mjs';

const three = noChromium ? null : await openThree({ after });
const scene = await webScene();

test('GLTFExporter', { skip: noChromium }, (t) =>
  assertRoundTrip(t, { name: 'GLTFExporter', run: (model) => three.written('GLTFExporter', model) }, scene, { survives: true }));

test('a marked scene looks as it did, also one that a tool wrote', { skip: noChromium }, async (t) => {
  const key = await fixedKey(8);
  for (const line of [null, 'gltfpack', 'gltfpack -cc', 'gltfpack -cz', 'gltf-transform optimize', 'gltf-transform draco', 'gltf-pipeline -d']) {
    const model = line ? await runTool(line, scene) : scene;
    const { bytes } = await embed(model, { key, image: logo(8) });
    await assertLooksTheSame(t, three, line ?? 'the scene', { model }, { model: bytes });
  }
});

test('pictures of different models differ', { skip: noChromium }, async () => {
  const [{ differing }] = await three.difference({ model: scene }, { model: await webScene(300) });
  assert.ok(differing > 0.01, `${differing}`);
});
