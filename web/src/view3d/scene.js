// SPDX-License-Identifier: MIT
// The drawn scene: three.js on a canvas that may live in a worker, drawn only when something changes.
import {
  AmbientLight, Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Group, Matrix4, Mesh, MeshLambertMaterial,
  PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer,
} from 'three';

const FIELD_OF_VIEW = 35;
const START = { azimuth: 0.6, height: 0.35, zoom: 1 };
const PLAIN = new Color(0xc6ccd8);

function meshOf({ positions, triangles, normals, matrix }, colours) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  if (normals) geometry.setAttribute('normal', new BufferAttribute(normals, 3));
  else geometry.computeVertexNormals();
  if (colours) geometry.setAttribute('color', new BufferAttribute(colours, 3, true));
  const mesh = new Mesh(geometry, new MeshLambertMaterial({ side: DoubleSide, color: PLAIN }));
  mesh.matrixAutoUpdate = false;
  mesh.matrix.copy(new Matrix4().fromArray(matrix));
  return mesh;
}

/** Around the middle of the bounding box, through the farthest vertex. */
function tightSphere(group) {
  const sphere = new Box3().setFromObject(group, true).getBoundingSphere(new Sphere());
  const point = new Vector3();
  let farthest = 0;
  group.traverse(({ isMesh, geometry, matrixWorld }) => {
    if (!isMesh) return;
    const { position } = geometry.attributes;
    for (let i = 0; i < position.count; ++i) {
      farthest = Math.max(farthest, point.fromBufferAttribute(position, i).applyMatrix4(matrixWorld).distanceToSquared(sphere.center));
    }
  });
  sphere.radius = Math.sqrt(farthest) || 1;
  return sphere;
}

export class ModelScene {
  #renderer;
  #camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
  #scene = new Scene();
  #sphere;
  #size = { width: 1, height: 1 };
  #view = { ...START };
  #groups = [];
  #split = null;

  /**
   * @param canvas   on screen or off
   * @param context  its WebGL 2 context: Firefox gives it out once
   * @param models   one or two (before, after) lists of pieces, each with `colours` or null
   */
  constructor(canvas, context, models) {
    this.#renderer = new WebGLRenderer({ canvas, context });
    this.#groups = models.map((pieces) => {
      const group = new Group();
      for (const piece of pieces) group.add(meshOf(piece, piece.colours));
      this.#scene.add(group);
      return group;
    });
    this.#scene.updateMatrixWorld(true);
    this.#sphere = tightSphere(this.#groups[0]);
    const sun = new DirectionalLight(0xffffff, 2.4);
    sun.position.set(0.5, 0.9, 1);
    this.#camera.add(sun, sun.target);
    this.#scene.add(new AmbientLight(0xffffff, 1.1), this.#camera);
  }

  setSize(width, height, pixelRatio) {
    this.#size = { width, height };
    this.#renderer.setPixelRatio(pixelRatio);
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
  }

  /** Colours of the vertices, or one plain colour. */
  setColoured(coloured) {
    this.#scene.traverse(({ isMesh, material, geometry }) => {
      if (!isMesh) return;
      material.vertexColors = coloured && geometry.hasAttribute('color');
      material.color.copy(material.vertexColors ? new Color(0xffffff) : PLAIN);
      material.needsUpdate = true;
    });
  }

  /** Left of `share` of the width the first model is drawn, right of it the second; null: the last one alone. */
  setSplit(share) {
    this.#split = share;
  }

  turn(azimuth, height) {
    this.#view.azimuth += azimuth;
    this.#view.height = Math.max(-1.5, Math.min(1.5, this.#view.height + height));
  }

  zoom(factor) {
    this.#view.zoom = Math.max(0.2, Math.min(20, this.#view.zoom * factor));
  }

  reset() {
    this.#view = { ...START };
  }

  #aim() {
    const { azimuth, height, zoom } = this.#view;
    const { center, radius } = this.#sphere;
    const narrow = Math.min(1, this.#camera.aspect);
    const distance = radius / Math.sin(FIELD_OF_VIEW * Math.PI / 360) / narrow / zoom;
    this.#camera.near = Math.max(distance - 1.2 * radius, distance / 1000);
    this.#camera.far = distance + 1.2 * radius;
    this.#camera.updateProjectionMatrix();
    const flat = Math.cos(height) * distance;
    this.#camera.position.set(center.x + Math.sin(azimuth) * flat, center.y + Math.sin(height) * distance, center.z + Math.cos(azimuth) * flat);
    this.#camera.lookAt(center);
  }

  draw() {
    this.#aim();
    const { width, height } = this.#size;
    const parts = this.#groups.length === 1 || this.#split === null
      ? [[this.#groups.length - 1, 0, width]]
      : [[0, 0, width * this.#split], [1, width * this.#split, width * (1 - this.#split)]];
    this.#renderer.setScissorTest(true);
    for (const [shown, x, wide] of parts) {
      this.#groups.forEach((group, i) => { group.visible = i === shown; });
      this.#renderer.setScissor(x, 0, wide, height);
      this.#renderer.render(this.#scene, this.#camera);
    }
  }
}
