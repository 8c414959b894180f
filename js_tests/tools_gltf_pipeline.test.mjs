// SPDX-License-Identifier: MIT
// gltf-pipeline reads what we write, and we read and mark what it writes.
import { testRoundTrips } from './support/round_trip.mjs';

await testRoundTrips([
  { line: 'gltf-pipeline', survives: true },
], ['Duck.glb']);
