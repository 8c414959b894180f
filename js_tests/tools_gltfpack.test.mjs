// SPDX-License-Identifier: MIT
// gltfpack reads what we write, and we read and mark what it writes.
import { test } from 'node:test';
import { assertRoundTrip } from './support/round_trip.mjs';
import { webScene } from './support/scenes.mjs';
import { tool } from './support/tools.mjs';

const scene = await webScene();

for (const { flags, survives } of [
  { flags: '-noq', survives: true },
  { flags: '-vpf' },
  { flags: '-c -noq', survives: true },
  { flags: '-cz -noq', survives: true },
]) {
  const line = `gltfpack ${flags}`.trim();
  test(line, (t) => assertRoundTrip(t, tool(line), scene, { survives }));
}
