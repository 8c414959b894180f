// SPDX-License-Identifier: MIT
// Any picture the browser can show as black and white pixels: fitted into a square, thresholded, previewed.

/** Decodes a PNG, JPEG or SVG; rejects when the browser cannot show it. */
export async function openPicture(file) {
  const url = URL.createObjectURL(file);
  try {
    const image = new Image();
    image.src = url;
    await image.decode();
    return image;
  } finally {
    URL.revokeObjectURL(url);
  }
}

/** Width and height of a picture whose longer side has `side` pixels. */
function fit(image, side) {
  const wide = image.naturalWidth || side, high = image.naturalHeight || side;  // an SVG need not have a size
  const scale = side / Math.max(wide, high);
  return { width: Math.max(1, Math.round(wide * scale)), height: Math.max(1, Math.round(high * scale)) };
}

/** Luminance per pixel, 0 to 1, on white; { width, height, light }. */
export function lightOf(image, side) {
  const { width, height } = fit(image, side);
  const canvas = new OffscreenCanvas(width, height);
  const drawing = canvas.getContext('2d');
  drawing.fillStyle = '#fff';
  drawing.fillRect(0, 0, width, height);
  drawing.imageSmoothingQuality = 'high';
  drawing.drawImage(image, 0, 0, width, height);
  const { data } = drawing.getImageData(0, 0, width, height);
  const light = Float32Array.from({ length: width * height }, (_, i) => (0.2126 * data[4 * i] + 0.7152 * data[4 * i + 1] + 0.0722 * data[4 * i + 2]) / 255);
  return { width, height, light };
}

/** Pixels darker than `threshold` are ink; with `invert` the others. */
export function thresholded({ width, height, light }, threshold, invert) {
  return { width, height, bits: Uint8Array.from(light, (value) => ((value < threshold) === invert ? 0 : 1)) };
}

/** The threshold that parts dark from light best (Otsu), in hundredths. */
export function bestThreshold({ light }) {
  const counts = new Uint32Array(101);
  for (const value of light) ++counts[Math.round(100 * value)];
  let best = 50, bestSpread = 0, below = 0, sumBelow = 0;
  const total = light.length, sum = counts.reduce((all, n, i) => all + n * i, 0);
  for (let i = 0; i < 100; ++i) {
    below += counts[i];
    sumBelow += counts[i] * i;
    if (below === 0 || below === total) continue;
    const gap = sumBelow / below - (sum - sumBelow) / (total - below);
    const spread = below * (total - below) * gap * gap;
    if (spread > bestSpread * (1 + 1e-9)) [best, bestSpread] = [i, spread];
  }
  // In the middle of the empty stretch above it, where a slider has room on both sides.
  let end = best + 1;
  while (end < 100 && counts[end] === 0) ++end;
  return Math.max(1, Math.min(99, Math.round((best + end) / 2)));
}

/** Draws bits on a canvas, one pixel each. */
export function drawBits(canvas, { width, height, bits }) {
  canvas.width = width;
  canvas.height = height;
  const pixels = new ImageData(width, height);
  bits.forEach((bit, i) => pixels.data.set(bit ? [0, 0, 0, 255] : [255, 255, 255, 255], 4 * i));
  canvas.getContext('2d').putImageData(pixels, 0, 0);
}
