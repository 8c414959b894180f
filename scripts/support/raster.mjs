// SPDX-License-Identifier: MIT
// Cameras and a z-buffer.

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export function unit(a) {
  const length = Math.sqrt(dot(a, a));
  return a.map((value) => value / length);
}

/** Three unit vectors, right, up and back, of someone who stands in direction `back` and looks at the origin. */
export function frame(back, upward = [0, 1, 0]) {
  const right = unit(cross(upward, back));
  return { right, up: cross(back, right), back };
}

/**
 * Projects vertices onto a picture of size * size pixels, x to the right, y down, depth growing away from the viewer.
 * @param camera  { right, up, back, centre, halfWidth, distance }: without `distance`, parallel projection
 * @return x, y, depth per vertex
 */
export function project(positions, { right, up, back, centre, halfWidth, distance }, size) {
  const result = new Float64Array(positions.length);
  for (let v = 0; v < positions.length; v += 3) {
    const p = [positions[v] - centre[0], positions[v + 1] - centre[1], positions[v + 2] - centre[2]];
    const depth = -dot(p, back);
    const scale = distance === undefined ? 1 : distance / (distance + depth);
    result[v] = (0.5 + (0.5 * scale * dot(p, right)) / halfWidth) * size;
    result[v + 1] = (0.5 - (0.5 * scale * dot(p, up)) / halfWidth) * size;
    result[v + 2] = depth;
  }
  return result;
}

/**
 * Which face each pixel shows, seen from either side.
 * @return { depth (Infinity where there is none), face (its number; -1 where there is none) } per pixel
 */
export function rasterize(projected, faces, size) {
  const depth = new Float32Array(size * size).fill(Infinity), face = new Int32Array(size * size).fill(-1);
  for (let f = 0; f < faces.length; f += 3) {
    const a = faces[f] * 3, b = faces[f + 1] * 3, c = faces[f + 2] * 3;
    const ax = projected[a], ay = projected[a + 1], bx = projected[b], by = projected[b + 1];
    const cx = projected[c], cy = projected[c + 1];
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area === 0) continue;
    const x0 = Math.max(0, Math.ceil(Math.min(ax, bx, cx) - 0.5)), y0 = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
    const x1 = Math.min(size - 1, Math.floor(Math.max(ax, bx, cx) - 0.5));
    const y1 = Math.min(size - 1, Math.floor(Math.max(ay, by, cy) - 0.5));
    for (let y = y0; y <= y1; ++y) {
      for (let x = x0; x <= x1; ++x) {
        const px = x + 0.5, py = y + 0.5;
        const u = ((bx - px) * (cy - py) - (by - py) * (cx - px)) / area;
        const v = ((cx - px) * (ay - py) - (cy - py) * (ax - px)) / area;
        const w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        const z = u * projected[a + 2] + v * projected[b + 2] + w * projected[c + 2], at = y * size + x;
        if (z < depth[at]) {
          depth[at] = z;
          face[at] = f / 3;
        }
      }
    }
  }
  return { depth, face };
}

/** Shares of the three corners of face `f` in the middle of pixel (x, y). */
export function corners(projected, faces, f, x, y) {
  const a = faces[f * 3] * 3, b = faces[f * 3 + 1] * 3, c = faces[f * 3 + 2] * 3, px = x + 0.5, py = y + 0.5;
  const ax = projected[a], ay = projected[a + 1], bx = projected[b], by = projected[b + 1];
  const cx = projected[c], cy = projected[c + 1];
  const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  const u = ((bx - px) * (cy - py) - (by - py) * (cx - px)) / area;
  const v = ((cx - px) * (ay - py) - (cy - py) * (ax - px)) / area;
  return [u, v, 1 - u - v];
}
