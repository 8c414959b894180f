// SPDX-License-Identifier: MIT
// gltfpack reads what we write, and we read and mark what it writes.
import { testRoundTrips } from './support/round_trip.mjs';

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
  { line: 'gltfpack -cz' },
], ['moltenDagger.glb', 'CesiumMan.glb']);
