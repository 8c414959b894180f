// SPDX-License-Identifier: MIT
// The colours of the difference picture, and their scale.
import { encodeSrgb } from './studio.mjs';
import { textCoverage, textWidth } from './strokes.mjs';

// Linear colours at even steps: pale clay, yellow, orange, red, violet. Brightness falls all the way.
const STEPS = [[0.72, 0.72, 0.7], [0.9, 0.62, 0.16], [0.85, 0.24, 0.05], [0.55, 0.04, 0.1], [0.16, 0.01, 0.2]];
const BAR_STEPS = 16;
const TEXT = 0x80;  // mid grey is legible on white and on black pages

/** @param value  0 to 1; larger ones get the last colour */
export function heat(value) {
  const at = Math.min(1, Math.max(0, value)) * (STEPS.length - 1), low = Math.min(STEPS.length - 2, Math.floor(at));
  return STEPS[low].map((part, i) => part + (at - low) * (STEPS[low + 1][i] - part));
}

/**
 * Draws the scale in the lower right corner of size * size pixels of straight RGBA: a bar and `labels` at even steps.
 * @return the bar's colours, for encodePicture() to keep
 */
export function drawScale(rgba, size, labels) {
  const width = Math.round(size * 0.2), thick = Math.round(size * 0.022), letters = Math.round(size * 0.024);
  const left = Math.round(size * 0.725), top = size - thick - 2 * letters - 6;
  const put = (x, y, [r, g, b], coverage) => {
    if (coverage > 0) rgba.set([r, g, b, Math.round(255 * coverage)], (y * size + x) * 4);
  };
  const bar = Array.from({ length: BAR_STEPS }, (_, i) => heat(i / (BAR_STEPS - 1)).map((part) => Math.round(encodeSrgb(part))));
  const starts = labels.map((label, i) => left + (width * i) / (labels.length - 1) - textWidth(label, letters) / 2);
  for (let y = 0; y < thick; ++y) {
    for (let x = 0; x < width; ++x) {
      // The ends are round.
      const dx = Math.max(0, thick / 2 - x - 0.5, x + 0.5 - (width - thick / 2)), dy = y + 0.5 - thick / 2;
      const coverage = Math.min(1, Math.max(0, thick / 2 + 0.5 - Math.sqrt(dx * dx + dy * dy)));
      put(left + x, top + y, bar[Math.floor((x * BAR_STEPS) / width)], coverage);
    }
  }
  for (let y = top + thick + 4; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const down = y + 0.5 - top - thick - 6;
      const coverage = Math.max(...labels.map((label, i) => textCoverage(label, letters, x + 0.5 - starts[i], down)));
      put(x, y, [TEXT, TEXT, TEXT], coverage);
    }
  }
  return bar.map(([r, g, b]) => ((r << 24) | (g << 16) | (b << 8) | 255) >>> 0);
}
