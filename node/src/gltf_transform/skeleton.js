// SPDX-License-Identifier: MIT
// A document's geometry as a GLB of its own: positions, triangles and the nodes that place them, and nothing else. The
// other attributes, textures and animations take no part in marking, so no copy of them is made, and every extension of
// the document stays untouched.
import { QuadmarkError } from '../error.js';

const COMPONENT_SIZE = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };
const QUANTIZATION = 'KHR_mesh_quantization';
const TRIANGLES = 4;  // with strips and fans above it

const named = (kind, property, index) => `${kind} ${index}${property.getName() ? ` ${JSON.stringify(property.getName())}` : ''}`;

/** Fails for arrays that marking would change for more than positions, or that glTF does not allow for them. */
function checkPositions(accessor, place) {
  const refuse = (what) => { throw new QuadmarkError('unsupported_file', `${place}: POSITION ${what}`); };
  if (accessor.getArray() === null) refuse('has no data');
  if (accessor.getType() !== 'VEC3') refuse(`is ${accessor.getType()}, not VEC3`);
  const type = accessor.getComponentType();
  if (![5120, 5121, 5122, 5123, 5126].includes(type)) refuse(`has component type ${type}, expected floats or integers of 8 or 16 bits`);
  for (const parent of accessor.listParents()) {
    if (parent.propertyType === 'Root') continue;
    const asPosition = parent.propertyType === 'Primitive' && parent.getAttribute('POSITION') === accessor &&
      parent.getIndices() !== accessor && parent.listAttributes().filter((attribute) => attribute === accessor).length === 1;
    if (!asPosition) refuse(`is read by another property too (${parent.propertyType})`);
  }
}

/** Collects arrays into one BIN chunk. */
class Body {
  views = [];
  parts = [];
  length = 0;

  /** @return index of the view */
  add(array, byteStride) {
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    this.views.push({ buffer: 0, byteOffset: this.length, byteLength: bytes.length, ...(byteStride ? { byteStride } : {}) });
    this.parts.push({ at: this.length, bytes });
    this.length += bytes.length + ((4 - (bytes.length % 4)) % 4);
    return this.views.length - 1;
  }
}

/** Components of `array` in elements of `stride` components: glTF wants vertices to begin at multiples of 4 bytes. */
function strided(array, stride) {
  if (stride === 3) return array;
  const out = new array.constructor((array.length / 3) * stride);
  for (let i = 0; i < array.length / 3; ++i) for (let axis = 0; axis < 3; ++axis) out[i * stride + axis] = array[3 * i + axis];
  return out;
}

const chunk = (type, bytes, fill) => {
  const padding = (4 - (bytes.length % 4)) % 4;
  const out = new Uint8Array(8 + bytes.length + padding).fill(fill);
  const view = new DataView(out.buffer);
  view.setUint32(0, bytes.length + padding, true);
  view.setUint32(4, type, true);
  out.set(bytes, 8);
  return out;
};

function glbOf(json, body) {
  const bin = new Uint8Array(body.length);
  for (const { at, bytes } of body.parts) bin.set(bytes, at);
  const chunks = [chunk(0x4e4f534a, new TextEncoder().encode(JSON.stringify(json)), 0x20), chunk(0x004e4942, bin, 0)];
  const glb = new Uint8Array(12 + chunks.reduce((sum, part) => sum + part.length, 0));
  const view = new DataView(glb.buffer);
  [0x46546c67, 2, glb.length].forEach((value, i) => view.setUint32(4 * i, value, true));
  let at = 12;
  for (const part of chunks) {
    glb.set(part, at);
    at += part.length;
  }
  return glb;
}

/**
 * The geometry of a glTF-Transform Document as a GLB.
 * @return { glb, places: [{ accessor, byteOffset, stride }] }  where in its BIN chunk the positions of each accessor are;
 *         stride in components
 * @throws QuadmarkError `unsupported_file`, naming mesh and primitive
 */
export function skeletonOf(document) {
  const root = document.getRoot();
  const body = new Body();
  const accessors = [], places = [];
  const numbers = new Map();
  let quantized = false;

  const addPositions = (accessor, place) => {
    if (numbers.has(accessor)) return numbers.get(accessor);
    checkPositions(accessor, place);
    const componentType = accessor.getComponentType();
    const size = COMPONENT_SIZE[componentType];
    const stride = size === 4 ? 3 : 4;
    quantized ||= size !== 4;
    const bufferView = body.add(strided(accessor.getArray(), stride), stride * size);
    places.push({ accessor, byteOffset: body.views[bufferView].byteOffset, stride });
    const number = accessors.push({
      bufferView, componentType, type: 'VEC3', count: accessor.getCount(), min: accessor.getMin([]), max: accessor.getMax([]),
      ...(accessor.getNormalized() ? { normalized: true } : {}),
    }) - 1;
    numbers.set(accessor, number);
    return number;
  };
  const addIndices = (accessor) => {
    if (numbers.has(accessor)) return numbers.get(accessor);
    const number = accessors.push({
      bufferView: body.add(accessor.getArray()), componentType: accessor.getComponentType(), type: 'SCALAR', count: accessor.getCount(),
    }) - 1;
    numbers.set(accessor, number);
    return number;
  };

  const meshNumbers = new Map();
  const meshes = [];
  root.listMeshes().forEach((mesh, i) => {
    const primitives = [];
    mesh.listPrimitives().forEach((primitive, k) => {
      const positions = primitive.getAttribute('POSITION');
      if (positions === null || primitive.getMode() < TRIANGLES) return;
      const POSITION = addPositions(positions, `${named('mesh', mesh, i)}, primitive ${k}`);
      const indices = primitive.getIndices();
      primitives.push({ attributes: { POSITION }, mode: primitive.getMode(), ...(indices ? { indices: addIndices(indices) } : {}) });
    });
    if (primitives.length > 0) meshNumbers.set(mesh, meshes.push({ name: mesh.getName(), primitives }) - 1);
  });
  if (meshes.length === 0) throw new QuadmarkError('bad_mesh', 'the document has no triangles with positions');

  const nodeList = root.listNodes();
  const nodeNumbers = new Map(nodeList.map((node, i) => [node, i]));
  const nodes = nodeList.map((node) => ({
    name: node.getName(), translation: node.getTranslation(), rotation: node.getRotation(), scale: node.getScale(),
    ...(meshNumbers.has(node.getMesh()) ? { mesh: meshNumbers.get(node.getMesh()) } : {}),
    ...(node.listChildren().length > 0 ? { children: node.listChildren().map((child) => nodeNumbers.get(child)) } : {}),
  }));
  const scenes = root.listScenes().map((scene) => {
    const children = scene.listChildren().map((node) => nodeNumbers.get(node));
    return children.length > 0 ? { nodes: children } : {};
  });
  const json = {
    asset: { version: '2.0' },
    ...(quantized ? { extensionsUsed: [QUANTIZATION], extensionsRequired: [QUANTIZATION] } : {}),
    ...(scenes.length > 0 ? { scene: Math.max(0, root.listScenes().indexOf(root.getDefaultScene())), scenes } : {}),
    ...(nodes.length > 0 ? { nodes } : {}),
    meshes, accessors, bufferViews: body.views, buffers: [{ byteLength: body.length }],
  };
  return { glb: glbOf(json, body), places };
}

/** Gives each accessor the positions that stand in a marked skeleton, in an array of its own. */
export function takePositions(glb, places) {
  const view = new DataView(glb.buffer, glb.byteOffset, glb.byteLength);
  const bin = glb.subarray(20 + view.getUint32(12, true) + 8);
  for (const { accessor, byteOffset, stride } of places) {
    const old = accessor.getArray();
    const bytes = bin.slice(byteOffset, byteOffset + (old.length / 3) * stride * old.BYTES_PER_ELEMENT);
    const marked = new old.constructor(bytes.buffer);
    const positions = stride === 3 ? marked : marked.filter((_, i) => i % stride < 3);
    if (positions.some((value, i) => value !== old[i])) accessor.setArray(positions);
  }
}
