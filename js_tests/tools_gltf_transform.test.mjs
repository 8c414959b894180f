// SPDX-License-Identifier: MIT
// glTF-Transform's command line reads what we write, and we read and mark what it writes.
import { testRoundTrips } from './support/round_trip.mjs';

await testRoundTrips([
  { line: 'gltf-transform copy', survives: true },
  { line: 'gltf-transform weld', survives: true },
  { line: 'gltf-transform simplify', survives: true },  // by its defaults, which remove hardly anything here
  { line: 'gltf-transform join', survives: true },
  { line: 'gltf-transform optimize --compress false', survives: true },
  { line: 'gltf-transform quantize' },
  { line: 'gltf-transform draco' },
  { line: 'gltf-transform meshopt' },
  { line: 'gltf-transform optimize' },
], ['CesiumMan.glb']);
