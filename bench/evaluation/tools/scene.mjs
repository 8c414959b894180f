// SPDX-License-Identifier: MIT
// A model as a small part of a scene. Tools that join meshes give it the grid of the whole.
import { getBounds, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { generate } from 'quadmark/lab';
import { readDocument } from '../../../js_tests/support/gltf_readers.mjs';

const NEIGHBOUR = { name: 'sculpture', vertices: 3000, seed: 77, format: 'glb' };
const TYPES = { 1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4' };

const sidesOf = ({ min, max }) => max.map((value, axis) => value - min[axis]);

/** An accessor for each attribute that `like` has, so that the two can be joined; unit vectors where length matters. */
function attributesLike(document, buffer, like, positions) {
  const count = positions.length / 3;
  return like.listSemantics().map((semantic) => {
    if (semantic === 'POSITION') return [semantic, document.createAccessor().setType('VEC3').setArray(positions).setBuffer(buffer)];
    const other = like.getAttribute(semantic), size = other.getElementSize();
    const array = new (other.getArray().constructor)(count * size);
    if (semantic === 'NORMAL' || semantic === 'TANGENT') for (let i = 0; i < array.length; i += size) array[i] = 1;
    return [semantic, document.createAccessor().setType(TYPES[size]).setArray(array).setNormalized(other.getNormalized()).setBuffer(buffer)];
  });
}

/**
 * Puts the model of a GLB into a corner of the box of another object, `share` times as large as its own: beside it, with
 * the same material.
 */
export async function besideLarge(glb, share) {
  const document = await readDocument(glb), root = document.getRoot();
  const scene = root.getDefaultScene() ?? root.listScenes()[0], [buffer] = root.listBuffers();
  const bounds = getBounds(scene), side = Math.max(...sidesOf(bounds));
  const like = root.listMeshes()[0].listPrimitives()[0];

  const [bare] = (await readDocument((await generate(NEIGHBOUR)).bytes)).getRoot().listMeshes()[0].listPrimitives();
  const positions = bare.getAttribute('POSITION').getArray().slice();
  const own = { min: bare.getAttribute('POSITION').getMin([]), max: bare.getAttribute('POSITION').getMax([]) };
  const scale = (share * side) / Math.max(...sidesOf(own));
  for (let i = 0; i < positions.length; ++i) positions[i] = bounds.min[i % 3] + (positions[i] - own.min[i % 3]) * scale;

  const primitive = document.createPrimitive().setMode(like.getMode()).setMaterial(like.getMaterial())
    .setIndices(document.createAccessor().setType('SCALAR').setArray(bare.getIndices().getArray().slice()).setBuffer(buffer));
  for (const [semantic, accessor] of attributesLike(document, buffer, like, positions)) primitive.setAttribute(semantic, accessor);
  scene.addChild(document.createNode('neighbour').setMesh(document.createMesh('neighbour').addPrimitive(primitive)));
  return Buffer.from(await new NodeIO().registerExtensions(ALL_EXTENSIONS).writeBinary(document));
}
