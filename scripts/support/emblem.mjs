// SPDX-License-Identifier: MIT
// The picture that the demonstration, the page's samples, the README and the tests hide in a model: the project's
// emblem, a quadrilateral and its diagonals, drawn by its equations at any size. Bold, so that it is recognised with
// half of its pixels gone; without symmetry, so that a turned or a mirrored one is noticed.

import { distanceToSegment } from './strokes.mjs';

// Corners in the unit square, in order; y points down.
const CORNERS = [[0.085, 0.36], [0.545, 0.085], [0.915, 0.42], [0.63, 0.915]];
const FRAME = 0.056, DIAGONAL = 0.04;  // half the width of the strokes

/** @return { width, height, bits } as the package takes it: 1 = ink */
export function drawEmblem(width, height = width) {
  const bits = new Uint8Array(width * height);
  for (let row = 0; row < height; ++row) {
    for (let column = 0; column < width; ++column) {
      const x = (column + 0.5) / width, y = (row + 0.5) / height;
      const frame = CORNERS.some((corner, i) => distanceToSegment(x, y, corner, CORNERS[(i + 1) % 4]) < FRAME);
      const diagonal = [0, 1].some((i) => distanceToSegment(x, y, CORNERS[i], CORNERS[i + 2]) < DIAGONAL);
      bits[row * width + column] = frame || diagonal ? 1 : 0;
    }
  }
  return { width, height, bits };
}
