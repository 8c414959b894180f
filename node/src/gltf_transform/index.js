// SPDX-License-Identifier: MIT
// Entry `quadmark/gltf-transform`: a transform for glTF-Transform's Document. Nothing of glTF-Transform is imported, so it
// is never bundled and the caller's version is the only one.
import { embed, parseKey } from 'quadmark';
import { known } from '../arguments.js';
import { QuadmarkError } from '../error.js';
import { skeletonOf, takePositions } from './skeleton.js';

const NAME = 'quadmark';

/** What applies where an option is not given. */
export const QUADMARK_DEFAULTS = Object.freeze({ strength: 'standard', salt: '' });

const EMBED_OPTIONS = ['strength', 'maxError', 'maxSlide', 'salt', 'selfTest', 'onProgress', 'signal'];

// Writing a document that has one of these quantizes its positions anew.
const LOSSY = ['KHR_draco_mesh_compression', 'EXT_meshopt_compression', 'KHR_meshopt_compression'];

function checkKey(key, document) {
  if (key.params?.scrambleOrder) {
    throw new QuadmarkError('bad_key', 'quadmark: a key with scrambleOrder also permutes vertices, which this transform does not');
  }
  const lossy = document.getRoot().listExtensionsUsed().map(({ extensionName }) => extensionName).filter((name) => LOSSY.includes(name));
  if (lossy.length === 0) return;
  if (key.scheme === 'paper') {
    throw new QuadmarkError('unsupported_file', `quadmark: ${lossy[0]} would remove a mark of scheme paper when the document is written; dispose the extension first`);
  }
  document.getLogger().warn(`quadmark: ${lossy[0]} will quantize the marked positions when the document is written; 10 bits or more keep the mark.`);
}

/** Documented in index.d.ts. */
export function quadmark(options) {
  const { key, image, id, text, onReport, ...rest } = known('quadmark', options, ['key', 'image', 'id', 'text', 'onReport', ...EMBED_OPTIONS]);
  if (key == null) throw new QuadmarkError('bad_option', 'quadmark: no key');
  if ([image, id, text].filter((given) => given != null).length !== 1) throw new QuadmarkError('bad_option', 'quadmark: give exactly one of image, id and text');
  if (onReport !== undefined && typeof onReport !== 'function') throw new QuadmarkError('bad_option', 'quadmark: onReport: expected a function');
  const transform = async (document) => {
    const checked = await parseKey(key);
    checkKey(checked, document);
    const { glb, places } = skeletonOf(document);
    const { bytes, report } = await embed(glb, { key: checked, image, id, text, options: rest });
    takePositions(bytes, places);
    const logger = document.getLogger();
    for (const warning of report.warnings) logger.warn(`quadmark: ${warning}`);
    logger.debug(`${NAME}: ${report.payloadBits} bits in ${report.cells} cells`);
    onReport?.(report);
  };
  Object.defineProperty(transform, 'name', { value: NAME });
  return transform;
}
