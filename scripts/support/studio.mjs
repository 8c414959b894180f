// SPDX-License-Identifier: MIT
// Photographs a mesh: three soft lights and a pale surrounding, each vertex lit from every direction from which nothing
// of the model hides it, so that shadows and the darkness of creases come from the model alone.
import { bounds, vertexNormals } from './mesh.mjs';
import { corners, dot, frame, project, rasterize, unit } from './raster.mjs';

const DIRECTIONS = 320;   // from which light comes
const SHADOW_SIZE = 400;  // pixels of the depth picture per direction
const SAMPLES = 3;        // per pixel and axis

// Direction in the camera's frame (right, up, towards it), colour, and concentration of each light.
const LIGHTS = [
  { from: unit([-0.62, 0.68, 0.55]), colour: [7.2, 6.5, 5.6], focus: 10 },   // key: warm, from the upper left
  { from: unit([0.9, 0.12, 0.5]), colour: [0.62, 0.78, 1.05], focus: 4 },   // fill: cool, from the right
  { from: unit([0.55, 0.62, -0.75]), colour: [3.4, 3.9, 4.8], focus: 12 },   // rim: from behind
];
const SKY = [0.16, 0.18, 0.22], GROUND = [0.1, 0.085, 0.075];
const GLOSS = 0.2, POLISH = 40;  // strength and sharpness of the highlights

/** Light that arrives from direction `d` of the camera's frame. */
function surrounding(d) {
  const height = (d[1] + 1) / 2;
  const light = SKY.map((sky, i) => GROUND[i] + (sky - GROUND[i]) * height);
  for (const { from, colour, focus } of LIGHTS) {
    const strength = Math.exp(focus * (dot(d, from) - 1));
    for (let i = 0; i < 3; ++i) light[i] += strength * colour[i];
  }
  return light;
}

/** Evenly spread directions: points of a spiral on the sphere. */
function directions(count) {
  const turn = Math.PI * (3 - Math.sqrt(5));
  return Array.from({ length: count }, (_, i) => {
    const y = 1 - (2 * i + 1) / count, r = Math.sqrt(1 - y * y);
    return [Math.cos(turn * i) * r, y, Math.sin(turn * i) * r];
  });
}

/** Arriving light, red, green and blue per vertex. */
function illuminate(mesh, normals, camera) {
  const { positions, faces } = mesh, { centre, diagonal } = bounds(mesh);
  const light = new Float64Array(positions.length);
  const texel = diagonal / SHADOW_SIZE;
  for (const d of directions(DIRECTIONS)) {
    const colour = surrounding(d);
    const world = [0, 1, 2].map((i) => camera.right[i] * d[0] + camera.up[i] * d[1] + camera.back[i] * d[2]);
    const view = { ...frame(world, Math.abs(world[1]) > 0.9 ? [1, 0, 0] : [0, 1, 0]), centre, halfWidth: diagonal / 2 };
    const projected = project(positions, view, SHADOW_SIZE);
    const { depth } = rasterize(projected, faces, SHADOW_SIZE);
    for (let v = 0; v < positions.length; v += 3) {
      const cosine = normals[v] * world[0] + normals[v + 1] * world[1] + normals[v + 2] * world[2];
      if (cosine <= 0) continue;
      const [x, y] = [v, v + 1].map((i) => Math.min(SHADOW_SIZE - 1, Math.max(0, Math.floor(projected[i]))));
      // The steeper the surface, the deeper it falls within one pixel of the depth picture.
      const margin = texel * (1 + 1.5 * Math.min(8, Math.sqrt(1 - Math.min(1, cosine * cosine)) / cosine));
      if (projected[v + 2] > depth[y * SHADOW_SIZE + x] + margin) continue;
      for (let i = 0; i < 3; ++i) light[v + i] += (4 / DIRECTIONS) * cosine * colour[i];
    }
  }
  return light;
}

/** Highlights of the lights on a surface seen from afar; `n` in the camera's frame, dimmed where little light arrives. */
function highlight(n, light) {
  const sum = [0, 0, 0];
  for (const { from, colour } of LIGHTS) {
    const half = unit([from[0], from[1], from[2] + 1]);
    const strength = GLOSS * Math.max(0, dot(n, half)) ** POLISH;
    for (let i = 0; i < 3; ++i) sum[i] += (strength * colour[i] * Math.min(1, light[i])) / 4;
  }
  return sum;
}

/** From linear light, 0 to 1, to 0 to 255 of sRGB. */
export const encodeSrgb = (x) => 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

/** From linear light to a level of sRGB, highlights rolled off. */
function develop(light) {
  const x = Math.max(0, light);
  const mapped = (x * (1 + x / 4)) / (1 + x);
  return Math.min(255, encodeSrgb(mapped));
}

/**
 * @param camera  see project(); right, up, back, centre, halfWidth, distance
 * @param paint   (light, shine, shares, vertices) => linear colour of a point, from the light [r, g, b] that arrives
 *                there, the highlight on it, and the shares of the three vertices (numbers) of its face
 * @return size * size pixels of straight RGBA, clear where there is no model
 */
export function photograph(mesh, camera, size, paint) {
  const normals = vertexNormals(mesh), light = illuminate(mesh, normals, camera);
  const fine = size * SAMPLES, projected = project(mesh.positions, camera, fine);
  const { face } = rasterize(projected, mesh.faces, fine);
  const rgba = Buffer.alloc(size * size * 4);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const sum = [0, 0, 0];
      let hits = 0;
      for (let s = 0; s < SAMPLES * SAMPLES; ++s) {
        const fx = x * SAMPLES + (s % SAMPLES), fy = y * SAMPLES + Math.floor(s / SAMPLES), f = face[fy * fine + fx];
        if (f < 0) continue;
        const shares = corners(projected, mesh.faces, f, fx, fy), vertices = mesh.faces.subarray(f * 3, f * 3 + 3);
        const mix = (values) => [0, 1, 2].map((i) => (
          shares[0] * values[vertices[0] * 3 + i] + shares[1] * values[vertices[1] * 3 + i] + shares[2] * values[vertices[2] * 3 + i]));
        const n = mix(normals), arriving = mix(light);
        const shine = highlight(unit([dot(n, camera.right), dot(n, camera.up), dot(n, camera.back)]), arriving);
        const colour = paint(arriving, shine, shares, vertices);
        for (let i = 0; i < 3; ++i) sum[i] += develop(colour[i]);
        ++hits;
      }
      if (hits === 0) continue;
      for (let i = 0; i < 3; ++i) rgba[(y * size + x) * 4 + i] = Math.round(sum[i] / hits);
      rgba[(y * size + x) * 4 + 3] = Math.round((255 * hits) / (SAMPLES * SAMPLES));
    }
  }
  return rgba;
}
