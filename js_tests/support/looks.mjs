// SPDX-License-Identifier: MIT
// What may be seen of a mark: hardly anything.
import assert from 'node:assert/strict';

const TOLERANCE = 8;     // of 255, in any channel
const MOST_PIXELS = 0.01;  // of the whole picture

/** Fails unless three draws the marked model as it draws the original: one camera, at rest and posed. */
export async function assertLooksTheSame(t, three, what, original, marked) {
  assert.deepEqual(await three.describe(marked.model, marked.resources), await three.describe(original.model, original.resources), what);
  for (const { what: pose, covered, differing } of await three.difference(original, marked, TOLERANCE)) {
    t.diagnostic(`${what}, ${pose}: ${(100 * differing).toFixed(2)} % of the pixels differ, the model covers ${(100 * covered).toFixed(0)} %`);
    assert.ok(covered > 0.02, `${what}, ${pose}: only ${covered} of the picture shows the model`);
    assert.ok(differing < MOST_PIXELS, `${what}, ${pose}: ${differing} of the pixels differ by more than ${TOLERANCE}`);
  }
}
