// SPDX-License-Identifier: MIT
// gltfpack reads what we write, and we read and mark what it writes.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { isDeepStrictEqual } from 'node:util';
import { embed } from 'quadmark';
import { openGltf } from './support/gltf.mjs';
import { validatorErrors } from './support/gltf_readers.mjs';
import { fixedKey, logo } from './support/marks.mjs';
import { testRoundTrips } from './support/round_trip.mjs';
import { webScene } from './support/scenes.mjs';
import { runTool } from './support/tools.mjs';

await testRoundTrips([
  { line: 'gltfpack -noq', survives: true },
  { line: 'gltfpack -c -noq', survives: true },
  { line: 'gltfpack -cz -noq', survives: true },
  { line: 'gltfpack -vpf' },
  { line: 'gltfpack' },
  { line: 'gltfpack -vp 16' },
  { line: 'gltfpack -vpn' },
  { line: 'gltfpack -c' },
  { line: 'gltfpack -cc' },
  { line: 'gltfpack -cc -vpf' },
  { line: 'gltfpack -cz' },
], ['moltenDagger.glb', 'CesiumMan.glb']);

test('the bounds of morph targets become true with the view that their positions share', async () => {
  // gltfpack declares the bounds of deltas before its filter rounds them; nobody sees that while they are compressed.
  const packed = await runTool('gltfpack -cc -vpf', await webScene());
  const marked = await embed(packed, { key: await fixedKey(8), image: logo(8) });
  const before = openGltf(packed).json, after = openGltf(marked.bytes).json;
  const corrected = after.meshes.flatMap(({ primitives }) => primitives).flatMap(({ targets = [] }) => targets)
    .map(({ POSITION }) => POSITION).filter((index) => !isDeepStrictEqual(after.accessors[index], before.accessors[index]));
  assert.ok(corrected.length > 0, 'this gltfpack declares true bounds: the test has lost its object');
  assert.equal(await validatorErrors(packed), 0);
  assert.equal(await validatorErrors(marked.bytes), 0);
});
