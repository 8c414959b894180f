// SPDX-License-Identifier: MIT
// glTF-Transform's command line reads what we write, and we read and mark what it writes.
import { test } from 'node:test';
import { assertRoundTrip } from './support/round_trip.mjs';
import { webScene } from './support/scenes.mjs';
import { tool } from './support/tools.mjs';

const scene = await webScene();

for (const { name, survives } of [
  { name: 'copy', survives: true },
  { name: 'weld', survives: true },
  { name: 'simplify', survives: true },  // by its defaults, which remove hardly anything here
  { name: 'join', survives: true },
  { name: 'optimize --compress false', survives: true },
]) {
  test(`gltf-transform ${name}`, (t) => assertRoundTrip(t, tool(`gltf-transform ${name}`), scene, { survives }));
}
