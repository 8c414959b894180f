// SPDX-License-Identifier: MIT
// Files told apart by content first, by name second.
import { t } from '../words/language.js';
import { baseName, decodedUri } from './paths.js';

const SNIFF_BYTES = 4096;
const MAX_JSON_BYTES = 32 * 2 ** 20;  // parsed here to tell a glTF from a key; larger ones go by their name
const PNG = [0x89, 0x50, 0x4e, 0x47], ZIP = [0x50, 0x4b, 0x03, 0x04];
const startsWith = (bytes, values) => values.every((value, i) => bytes[i] === value);

/**
 * What one file is: "model", "key", "picture", "archive" or "other", and for a glTF the names of the pictures it uses.
 * Damaged files count as what their name says, so that reading them tells what is wrong.
 */
async function classify({ file }) {
  const head = new Uint8Array(await file.slice(0, SNIFF_BYTES).arrayBuffer());
  const text = new TextDecoder().decode(head).replace(/^\ufeff/, '').trimStart();
  if (text.startsWith('glTF') || text.startsWith('DRACO') || /^ply\s/.test(text)) return { kind: 'model' };
  if (startsWith(head, PNG)) return { kind: 'picture' };
  if (startsWith(head, ZIP)) return { kind: 'archive' };
  const extension = /\.([^.]+)$/.exec(file.name)?.[1].toLowerCase();
  if (text.startsWith('{') && file.size <= MAX_JSON_BYTES) {
    try {
      const json = JSON.parse(await file.text());
      if (json.quadmark !== undefined) return { kind: 'key' };
      if (json.asset !== undefined || json.buffers !== undefined) {
        const images = Array.isArray(json.images) ? json.images : [];
        return { kind: 'model', textures: images.map((image) => image?.uri).filter((uri) => typeof uri === 'string').map(decodedUri) };
      }
    } catch {
      // Broken JSON: by name.
    }
  }
  if (['glb', 'gltf', 'ply', 'drc'].includes(extension)) return { kind: 'model' };
  if (extension === 'zip') return { kind: 'archive' };
  if (extension === 'json') return { kind: 'key' };
  if (extension === 'png') return { kind: 'picture' };
  return { kind: 'other' };
}

/**
 * Sorts items by what they are for.
 * @param {Item[]} items
 * @return {Promise<{ models: Item[], key?: Item, reference?: Item, archives: Item[], parts: Item[], notices: string[] }>}
 *         parts: possible external buffers of a glTF; notices: sentences on what was not taken, and why
 */
export async function sortItems(items) {
  const notices = [];
  const kinds = { model: [], key: [], picture: [], archive: [], other: [] };
  const textures = new Set();
  for (const item of items) {
    try {
      const { kind, textures: used = [] } = await classify(item);
      kinds[kind].push(item);
      for (const uri of used) textures.add(baseName(uri));
    } catch (error) {
      notices.push(t('couldNotOpen', { path: item.path, why: error.message }));
    }
  }
  const parts = [...kinds.other];
  const pictures = [];
  for (const item of kinds.picture) (textures.has(baseName(item.path)) ? parts : pictures).push(item);

  const one = (list, what) => {
    if (list.length > 1) {
      const names = list.slice(0, 3).map(({ path }) => path).join(', ') + (list.length > 3 ? ', …' : '');
      notices.push(t('severalAtOnce', { n: list.length, what: t(what), names }));
    }
    return list.length === 1 ? list[0] : undefined;
  };
  const inFolder = ({ path }) => path.includes('/');
  const reference = pictures.length > 1 && pictures.every(inFolder) ? undefined : one(pictures, 'pictureFiles');
  return { models: kinds.model, key: one(kinds.key, 'keyFiles'), reference, archives: kinds.archive, parts, notices };
}

/**
 * Tells files that may be buffers of a glTF from those that are of no use.
 * @param models  those of the same drop
 * @return {{ parts: Item[], notices: string[] }}  notices: a sentence on each useless file that did not come in a folder
 */
export function splitStrangers(items, models) {
  if (models.some(({ path }) => !/\.(glb|ply|drc)$/i.test(path))) return { parts: items, notices: [] };
  const mayBePart = ({ path }) => /\.bin$/i.test(path);
  return {
    parts: items.filter(mayBePart),
    notices: items.filter((item) => !mayBePart(item) && !item.path.includes('/')).map(({ path }) => t('leftAside', path)),
  };
}
