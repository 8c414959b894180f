// SPDX-License-Identifier: MIT
// The thread that draws: reads the model, colours it and draws it on a canvas it was given, so that the page stays
// free however large the model is.
//   in   { type: 'open', canvas, width, height, pixelRatio, model: Item, parts: Item[],
//          evidence?: Float32Array, after?: { model, parts } }   once, then
//        { type: 'size' | 'turn' | 'zoom' | 'reset' | 'colour' | 'split', ... }
//   out  { type: 'ready', vertices, coloured, most, reference }   most: largest displacement, fraction of the diagonal
//        { type: 'failed', reason }                               the name of a text
//        { type: 'picture', blob }                                after the view has come to rest
import { findPart } from '../files/paths.js';
import { readGeometry } from './geometry/index.js';
import { NotDrawable } from './geometry/not_drawable.js';
import { displacementColours, displacements, evidenceColours } from './heat.js';

const REST = 250;  // milliseconds without a change before the picture for printing is taken

let scene = null;
let canvas = null;
let drawing = false;
let resting = 0;

const openDraco = async () => (await import('./draco_decoder.js')).openDracoDecoder();

async function read({ model, parts }) {
  const bytes = new Uint8Array(await model.file.arrayBuffer());
  return readGeometry(bytes, async (uri) => {
    const part = findPart(uri, model.path, parts);
    if (!part) throw new NotDrawable('noShape');
    return new Uint8Array(await part.file.arrayBuffer());
  }, openDraco);
}

/** Colours by evidence; whether there was any that fits this model. */
function colourEvidence({ pieces, vertexCount }, evidence) {
  if (evidence.length === 0 || vertexCount !== evidence.length) return false;
  for (const piece of pieces) piece.colours = evidenceColours(Float32Array.from(piece.numbers, (number) => evidence[number]), piece.triangles);
  return true;
}

function diagonalOf(pieces) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const { positions } of pieces) {
    for (let i = 0; i < positions.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], positions[i]);
      high[i % 3] = Math.max(high[i % 3], positions[i]);
    }
  }
  return Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

/** Colours the second model by how far its vertices lie from the first one's; the largest distance per diagonal. */
function colourDifference(before, after) {
  const fits = before.pieces.length === after.pieces.length
    && before.pieces.every((piece, i) => piece.positions.length === after.pieces[i].positions.length);
  if (!fits) throw new NotDrawable('noShape');
  const moved = after.pieces.map((piece, i) => displacements(before.pieces[i].positions, piece.positions));
  const most = Math.max(...moved.map((lengths) => lengths.reduce((a, b) => Math.max(a, b), 0)));
  after.pieces.forEach((piece, i) => { piece.colours = displacementColours(moved[i], most); });
  return most / diagonalOf(before.pieces);
}

async function open(request) {
  canvas = request.canvas;
  const context = canvas.getContext('webgl2', { antialias: true, alpha: true });
  if (!context) throw new NotDrawable('noWebgl');
  const first = await read(request);
  const second = request.after ? await read(request.after) : null;
  const most = second ? colourDifference(first, second) : 0;
  const coloured = second !== null || colourEvidence(first, request.evidence);
  const { ModelScene } = await import('./scene.js');
  scene = new ModelScene(canvas, context, (second ? [first, second] : [first]).map(({ pieces }) => pieces));
  scene.setSize(request.width, request.height, request.pixelRatio);
  scene.setColoured(coloured && !second);
  if (second) scene.setSplit(0.5);
  draw();
  postMessage({ type: 'ready', vertices: first.pieces.reduce((sum, { positions }) => sum + positions.length / 3, 0), coloured, most });
}

/** Draws once for all changes up to the next frame. */
function draw() {
  if (drawing) return;
  drawing = true;
  requestAnimationFrame(() => {
    drawing = false;
    scene.draw();
    clearTimeout(resting);
    resting = setTimeout(takePicture, REST);
  });
}

function takePicture() {
  scene.draw();  // what was drawn in an earlier task is gone from the canvas
  canvas.convertToBlob({ type: 'image/png' }).then((blob) => postMessage({ type: 'picture', blob }));
}

const CHANGES = {
  size: ({ width, height, pixelRatio }) => scene.setSize(width, height, pixelRatio),
  turn: ({ azimuth, height }) => scene.turn(azimuth, height),
  zoom: ({ factor }) => scene.zoom(factor),
  reset: () => scene.reset(),
  colour: ({ coloured }) => scene.setColoured(coloured),
  split: ({ share }) => scene.setSplit(share),
};

self.addEventListener('message', async ({ data }) => {
  if (data.type === 'open') {
    await open(data).catch((error) => postMessage({ type: 'failed', reason: error instanceof NotDrawable ? error.message : 'noShape' }));
  } else if (scene) {
    CHANGES[data.type](data);
    draw();
  }
});
