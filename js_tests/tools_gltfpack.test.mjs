// SPDX-License-Identifier: MIT
// gltfpack reads what we write, and we read and mark what it writes.
import { testRoundTrips } from './support/round_trip.mjs';

await testRoundTrips([
  { line: 'gltfpack -noq', survives: true },
  { line: 'gltfpack -c -noq', survives: true },
  { line: 'gltfpack -cz -noq', survives: true },
  { line: 'gltfpack -vpf' },
], ['moltenDagger.glb', 'CesiumMan.glb']);
