// SPDX-License-Identifier: MIT
// Shapes drawn as strokes of a round pen: the emblem, and the few characters that a legend needs.

/** @return the distance of (x, y) to the segment from `a` to `b` */
export function distanceToSegment(x, y, [ax, ay], [bx, by]) {
  const dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
  const t = square === 0 ? 0 : Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / square));
  const ex = x - ax - t * dx, ey = y - ay - t * dy;
  return Math.sqrt(ex * ex + ey * ey);
}

/** Part of an ellipse as a chain of points; angles in degrees, clockwise from the right, since y points down. */
function arc(cx, cy, rx, ry, from = 0, to = 360) {
  return Array.from({ length: 25 }, (_, i) => {
    const angle = ((from + ((to - from) * i) / 24) * Math.PI) / 180;
    return [cx + rx * Math.cos(angle), cy + ry * Math.sin(angle)];
  });
}

// Advance and chains of points per character; capitals are 1 high, on the line y = 1.
const GLYPHS = {
  '0': [0.72, [arc(0.3, 0.5, 0.28, 0.48)]],
  '1': [0.72, [[[0.1, 0.2], [0.34, 0.02], [0.34, 0.98]]]],
  '5': [0.72, [[[0.54, 0.02], [0.12, 0.02], [0.07, 0.46], ...arc(0.28, 0.67, 0.29, 0.31, -137, 140)]]],
  '.': [0.34, [[[0.11, 0.97], [0.11, 0.97]]]],
  '%': [1.1, [arc(0.22, 0.24, 0.18, 0.22), arc(0.82, 0.76, 0.18, 0.22), [[0.84, 0.02], [0.2, 0.98]]]],
  '≥': [0.8, [[[0.05, 0.12], [0.6, 0.4], [0.05, 0.68]], [[0.05, 0.95], [0.6, 0.95]]]],
  ' ': [0.34, []],
};

export const textWidth = (text, height) => [...text].reduce((sum, character) => sum + GLYPHS[character][0] * height, 0);

/** How much of the pixel at (x, y) a text covers whose top left corner is the origin: 0 to 1. */
export function textCoverage(text, height, x, y) {
  const pen = height * 0.075;
  let left = 0, nearest = Infinity;
  for (const character of text) {
    const [advance, chains] = GLYPHS[character];
    for (const chain of chains) {
      for (let i = 1; i < chain.length; ++i) {
        const [a, b] = [chain[i - 1], chain[i]].map(([u, v]) => [left + u * height, v * height]);
        nearest = Math.min(nearest, distanceToSegment(x, y, a, b));
      }
    }
    left += advance * height;
  }
  return Math.min(1, Math.max(0, pen + 0.5 - nearest));
}
