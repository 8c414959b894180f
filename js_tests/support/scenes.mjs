// SPDX-License-Identifier: MIT
// Generated models dressed as web builds see them: nodes with transforms, normals, texture coordinates, a texture,
// a mesh with seams and a morph target, and one that five nodes share. Written by glTF-Transform, not by us.
import { Document, NodeIO } from '@gltf-transform/core';
import { generate } from 'quadmark/lab';
import { readDocument } from './gltf_readers.mjs';
import { logo, logoPng } from './marks.mjs';

/** Unit normals at the vertices, weighted by area; none is zero. */
function vertexNormals(positions, indices) {
  const normals = new Float32Array(positions.length);
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = indices.subarray(i, i + 3);
    const edge = (to, axis) => positions[3 * to + axis] - positions[3 * a + axis];
    for (let axis = 0; axis < 3; ++axis) {
      const y = (axis + 1) % 3, z = (axis + 2) % 3;
      const area = edge(b, y) * edge(c, z) - edge(b, z) * edge(c, y);
      for (const vertex of [a, b, c]) normals[3 * vertex + axis] += area;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(...normals.subarray(i, i + 3));
    if (length > 0) for (let axis = 0; axis < 3; ++axis) normals[i + axis] /= length;
    else normals[i] = 1;
  }
  return normals;
}

async function addMesh(document, material, name, vertices) {
  const { bytes } = await generate({ name, vertices, format: 'glb' });
  const [bare] = (await readDocument(bytes)).getRoot().listMeshes()[0].listPrimitives();
  const positions = bare.getAttribute('POSITION').getArray(), indices = bare.getIndices().getArray();
  const uv = Float32Array.from({ length: (positions.length / 3) * 2 }, (_, i) => positions[3 * (i >> 1) + (i & 1)] / 8 + 0.5);
  const [buffer] = document.getRoot().listBuffers();
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const primitive = document.createPrimitive().setMaterial(material)
    .setIndices(accessor('SCALAR', indices.slice()))
    .setAttribute('POSITION', accessor('VEC3', positions.slice()))
    .setAttribute('NORMAL', accessor('VEC3', vertexNormals(positions, indices)))
    .setAttribute('TEXCOORD_0', accessor('VEC2', uv));
  return document.createMesh(name).addPrimitive(primitive);
}

/** Adds a morph target, off by default, that stretches the mesh upwards. */
function addMorph(document, mesh) {
  const [primitive] = mesh.listPrimitives();
  const deltas = primitive.getAttribute('POSITION').getArray().map((value, i) => (i % 3 === 1 ? value / 4 : 0));
  const accessor = document.createAccessor().setType('VEC3').setArray(deltas).setBuffer(document.getRoot().listBuffers()[0]);
  primitive.addTarget(document.createPrimitiveTarget('tall').setAttribute('POSITION', accessor));
  mesh.setWeights([0]);
}

/** A GLB of seven nodes: a sculpture of about `vertices` vertices, a smaller seamed mesh, and one ball five times. */
export async function webScene(vertices = 3000) {
  const document = new Document();
  document.createBuffer();
  const texture = document.createTexture('pattern').setImage(new Uint8Array(logoPng(logo(32)))).setMimeType('image/png');
  const material = document.createMaterial('clay').setBaseColorTexture(texture).setRoughnessFactor(0.7).setMetallicFactor(0);
  const ball = await addMesh(document, material, 'icosphere', 600);
  const pedestal = await addMesh(document, material, 'seamed', 1000);
  addMorph(document, pedestal);
  const turned = Math.SQRT1_2;
  const nodes = [
    document.createNode('statue').setMesh(await addMesh(document, material, 'sculpture', vertices)).setRotation([0, turned, 0, turned]),
    document.createNode('pedestal').setMesh(pedestal).setTranslation([0, -1.3, 0]).setScale([1.5, 0.5, 1.5]),
    ...[-2, -1, 0, 1, 2].map((place) => document.createNode(`ball ${place}`).setMesh(ball)
      .setTranslation([0.7 * place, -0.7, 1]).setScale([0.2, 0.2, 0.2])),
  ];
  const scene = document.createScene('gallery');
  nodes.forEach((node) => scene.addChild(node));
  return new NodeIO().writeBinary(document);
}
