// SPDX-License-Identifier: MIT
// Runs in Chromium: models loaded, drawn and exported by three, as a viewer on the web does it.
import * as THREE from 'three';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { DRACOExporter } from 'three/addons/exporters/DRACOExporter.js';
import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';
import { OBJExporter } from 'three/addons/exporters/OBJExporter.js';
import { PLYExporter } from 'three/addons/exporters/PLYExporter.js';
import { STLExporter } from 'three/addons/exporters/STLExporter.js';
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';
import { PLYLoader } from 'three/addons/loaders/PLYLoader.js';
import { STLLoader } from 'three/addons/loaders/STLLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';

const SIZE = 512;

const draco = new DRACOLoader().setDecoderPath('/draco/');
const gltfLoader = new GLTFLoader().setDRACOLoader(draco).setMeshoptDecoder(MeshoptDecoder);

/** { root, clips } of a model by URL. */
async function load(url) {
  if (!url.endsWith('.ply')) {
    const { scene, animations } = await gltfLoader.loadAsync(url);
    return { root: scene, clips: animations };
  }
  const geometry = await new PLYLoader().loadAsync(url);
  if (!geometry.index) throw new Error(`${url}: PLYLoader finds no faces`);
  if (!geometry.getAttribute('normal')) geometry.computeVertexNormals();
  return { root: new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: 0xb0b0b0 })), clips: [] };
}

/** Puts a model into the pose that skins, morph targets and animations give it some way into the first animation. */
function pose({ root, clips }) {
  if (clips.length > 0) {
    const mixer = new THREE.AnimationMixer(root);
    mixer.clipAction(clips[0]).play();
    mixer.setTime(0.4 * clips[0].duration);
  } else {
    root.traverse((object) => object.morphTargetInfluences?.fill(0.5));
  }
}

const isPosed = ({ root, clips }) => {
  let morphs = false;
  root.traverse((object) => { morphs ||= (object.morphTargetInfluences?.length ?? 0) > 0; });
  return clips.length > 0 || morphs;
};

/** A camera that sees all of the model, nearly filling the picture. */
function cameraFor(root) {
  root.updateMatrixWorld(true);
  const sphere = new THREE.Box3().setFromObject(root, true).getBoundingSphere(new THREE.Sphere());
  const camera = new THREE.PerspectiveCamera(35, 1, sphere.radius / 100, sphere.radius * 10);
  camera.position.set(0.6, 0.45, 1).normalize().multiplyScalar(3.2 * sphere.radius).add(sphere.center);
  camera.lookAt(sphere.center);
  return camera;
}

const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(SIZE, SIZE, false);
const background = new THREE.Color(0x203040);
const room = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment()).texture;

/** RGBA of the model as the camera sees it. */
function draw({ root }, camera) {
  const scene = new THREE.Scene();
  scene.background = background;
  scene.environment = room;
  scene.add(root);
  renderer.render(scene, camera);
  const gl = renderer.getContext();
  const pixels = new Uint8Array(4 * SIZE * SIZE);
  gl.readPixels(0, 0, SIZE, SIZE, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  return pixels;
}

/** Shares of all pixels: covered by the model, and of another colour by more than `tolerance` of 255 in any channel. */
function compare(before, after, tolerance) {
  const corner = before.slice(0, 4);
  let covered = 0, differing = 0;
  for (let i = 0; i < before.length; i += 4) {
    const channels = [0, 1, 2];
    if (channels.some((c) => before[i + c] !== corner[c])) ++covered;
    if (channels.some((c) => Math.abs(before[i + c] - after[i + c]) > tolerance)) ++differing;
  }
  const all = before.length / 4;
  return { covered: covered / all, differing: differing / all };
}

/** A picture of pixels as a data: URL, the first row at the bottom as WebGL has it. */
function encoded(pixels) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = SIZE;
  const flipped = new Uint8ClampedArray(pixels.length), row = 4 * SIZE;
  for (let y = 0; y < SIZE; ++y) flipped.set(pixels.subarray(row * y, row * (y + 1)), row * (SIZE - 1 - y));
  canvas.getContext('2d').putImageData(new ImageData(flipped, SIZE, SIZE), 0, 0);
  return canvas.toDataURL('image/webp', 0.9);
}

/** How far two pictures are apart where the first shows the model: levels of 0 to 255, the largest of three channels. */
function apart(before, after, amplify) {
  const corner = before.slice(0, 4), shown = new Uint8Array(before.length);
  let covered = 0, sum = 0, most = 0;
  for (let i = 0; i < before.length; i += 4) {
    let level = 0, covers = false;
    for (let c = 0; c < 3; ++c) {
      const difference = Math.abs(before[i + c] - after[i + c]);
      level = Math.max(level, difference);
      covers ||= before[i + c] !== corner[c];
      shown[i + c] = Math.min(255, amplify * difference);
    }
    shown[i + 3] = 255;
    most = Math.max(most, level);
    if (!covers) continue;
    ++covered;
    sum += level;
  }
  return { covered: covered / (before.length / 4), most, mean: covered > 0 ? sum / covered : 0, shown };
}

/** The only mesh of a model, for exporters that take no more. */
function onlyMesh(root) {
  const meshes = [];
  root.traverse((object) => { if (object.isMesh) meshes.push(object); });
  if (meshes.length !== 1) throw new Error(`it takes one mesh, and this model has ${meshes.length}`);
  return meshes[0];
}

const glb = (root, animations = []) => new GLTFExporter().parseAsync(root, { binary: true, animations });

// By exporter; files of kinds that we do not read come back as a GLB, over three's own loader.
const written = {
  GLTFExporter: ({ root, clips }) => glb(root, clips),
  DRACOExporter: ({ root }) => new DRACOExporter().parseAsync(onlyMesh(root)),
  PLYExporter: ({ root }) => new PLYExporter().parse(root, null, { binary: false }),
  OBJExporter: ({ root }) => glb(new OBJLoader().parse(new OBJExporter().parse(root))),
  STLExporter: ({ root }) => glb(new THREE.Mesh(new STLLoader().parse(new STLExporter().parse(root, { binary: true }).buffer))),
};

window.three = {
  /** What three finds in a model. */
  async describe(url) {
    const { root, clips } = await load(url);
    let meshes = 0, vertices = 0;
    root.traverse((object) => {
      if (!object.isMesh) return;
      ++meshes;
      vertices += object.geometry.getAttribute('position').count;
    });
    return { meshes, vertices, animations: clips.length };
  },

  /** The pictures of two models from one camera, compared: as loaded and, where something moves them, in a pose. */
  async difference(urlBefore, urlAfter, tolerance) {
    const before = await load(urlBefore), after = await load(urlAfter);
    const results = [];
    const shoot = (what) => {
      const camera = cameraFor(before.root);
      results.push({ what, ...compare(draw(before, camera), draw(after, camera), tolerance) });
    };
    shoot('at rest');
    if (isPosed(before)) {
      pose(before);
      pose(after);
      shoot('in a pose');
    }
    return results;
  },

  /** Two models and their difference from one camera, as pictures, with the largest and mean difference of a pixel. */
  async pictures(urlBefore, urlAfter, amplify) {
    const before = await load(urlBefore), after = await load(urlAfter), camera = cameraFor(before.root);
    const first = draw(before, camera), second = draw(after, camera), { shown, ...figures } = apart(first, second, amplify);
    return { before: encoded(first), after: encoded(second), difference: encoded(shown), ...figures };
  },

  /** What one of three's exporters makes of a model, as base64. */
  async written(url, exporter) {
    const reader = new FileReader();
    reader.readAsDataURL(new Blob([await written[exporter](await load(url))]));
    await new Promise((resolve) => { reader.onload = resolve; });
    return reader.result.slice(reader.result.indexOf(',') + 1);
  },

  revision: THREE.REVISION,
};
