// SPDX-License-Identifier: MIT
// Which models need the module with Draco's decoder, told from their bytes before any module is loaded.

const bytesOf = (text) => Uint8Array.from(text, (character) => character.charCodeAt(0));
const DRACO = bytesOf('DRACO');
const EXTENSION = bytesOf('"KHR_draco_mesh_compression"');
const GLB = bytesOf('glTF');
const GLB_JSON_LENGTH = 12, GLB_JSON = 20;

const matches = (bytes, at, word) => word.every((byte, i) => bytes[at + i] === byte);

function contains(bytes, word) {
  for (let at = bytes.indexOf(word[0]); at >= 0; at = bytes.indexOf(word[0], at + 1)) {
    if (matches(bytes, at, word)) return true;
  }
  return false;
}

/** The JSON text of a GLB or .gltf; nothing of other files. */
function jsonOf(model) {
  if (!matches(model, 0, GLB)) return model[0] === 0x70 /* p of ply */ ? model.subarray(0, 0) : model;
  if (model.length < GLB_JSON) return model;
  const length = new DataView(model.buffer, model.byteOffset).getUint32(GLB_JSON_LENGTH, true);
  return model.subarray(GLB_JSON, GLB_JSON + length);
}

/**
 * Whether a model is a .drc, or a glTF whose JSON names the extension. Only a text that spells the name with escapes
 * is missed; the other module then refuses it by name.
 * @param {Uint8Array} model
 */
export const needsDraco = (model) => matches(model, 0, DRACO) || contains(jsonOf(model), EXTENSION);
