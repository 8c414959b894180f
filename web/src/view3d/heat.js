// SPDX-License-Identifier: MIT
// Colours per vertex: evidence for and against the mark, or how far marking moved it. Blue and orange, which the
// common kinds of colour blindness keep apart; the legends in styles/view.css show the same colours.

const PLAIN = [198, 204, 216], FOR = [24, 92, 214], AGAINST = [226, 112, 18], MOVED = [176, 24, 84];
const REACH = 3;          // edges over which a vote is spread
const SPREAD = 0.6;       // of a vote's weight that each step passes on
const FULL_WEIGHT = 0.35;  // from this weight on a colour is strong

/** Passes a value on along the edges of triangles: sums and weights per vertex. */
function spread(sums, weights, triangles) {
  const nextSums = sums.slice(), nextWeights = weights.slice();
  for (let i = 0; i < triangles.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const from = triangles[i + k], to = triangles[i + (k + 1) % 3];
      // Each edge belongs to two triangles, which run along it both ways.
      nextSums[to] += SPREAD * sums[from] / 3;
      nextWeights[to] += SPREAD * weights[from] / 3;
    }
  }
  return [nextSums, nextWeights];
}

function mix(out, at, from, to, share) {
  for (let c = 0; c < 3; ++c) out[at + c] = from[c] + (to[c] - from[c]) * share;
}

/**
 * @param values     -1 to 1 per vertex, 0 = no vote
 * @param triangles  three vertices each
 * @return Uint8Array, red, green, blue per vertex
 */
export function evidenceColours(values, triangles) {
  let sums = Float32Array.from(values), weights = Float32Array.from(values, (value) => (value === 0 ? 0 : 1));
  for (let i = 0; i < REACH; ++i) [sums, weights] = spread(sums, weights, triangles);
  const colours = new Uint8Array(3 * values.length);
  for (let v = 0; v < values.length; ++v) {
    const mean = weights[v] > 0 ? sums[v] / weights[v] : 0;
    mix(colours, 3 * v, PLAIN, mean >= 0 ? FOR : AGAINST, Math.min(1, Math.abs(mean)) * Math.min(1, weights[v] / FULL_WEIGHT));
  }
  return colours;
}

/** @param lengths  per vertex; @param most  what gets the full colour */
export function displacementColours(lengths, most) {
  const colours = new Uint8Array(3 * lengths.length);
  lengths.forEach((length, v) => mix(colours, 3 * v, PLAIN, MOVED, most > 0 ? Math.sqrt(Math.min(1, length / most)) : 0));
  return colours;
}

/** How far each vertex moved between two readings of one layout. */
export function displacements(before, after) {
  const lengths = new Float32Array(before.length / 3);
  for (let v = 0; v < lengths.length; ++v) {
    lengths[v] = Math.hypot(after[3 * v] - before[3 * v], after[3 * v + 1] - before[3 * v + 1], after[3 * v + 2] - before[3 * v + 2]);
  }
  return lengths;
}
