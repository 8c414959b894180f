// SPDX-License-Identifier: MIT
// gltf-pipeline reads what we write, and we read and mark what it writes.
import { test } from 'node:test';
import { assertRoundTrip } from './support/round_trip.mjs';
import { webScene } from './support/scenes.mjs';
import { tool } from './support/tools.mjs';

const scene = await webScene();

test('gltf-pipeline', (t) => assertRoundTrip(t, tool('gltf-pipeline'), scene, { survives: true }));
