// SPDX-License-Identifier: MIT
// gltf-pipeline reads what we write, and we read and mark what it writes.
import { testRoundTrips } from './support/round_trip.mjs';

await testRoundTrips([
  { line: 'gltf-pipeline', survives: true },
  { line: 'gltf-pipeline -d' },
  { line: 'gltf-pipeline -d --draco.quantizePositionBits 16' },
], ['Duck.glb']);
