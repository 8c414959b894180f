// SPDX-License-Identifier: MIT
// What the user dropped or chose: collected from folders too, and told apart by content first, by name second.

/** More than this in one drop is somebody's whole disk. */
export const MAX_FILES = 2000;
const SNIFF_BYTES = 4096;
const MAX_JSON_BYTES = 32 * 2 ** 20;  // parsed here to tell a glTF from a key; larger ones go by their name

/** @typedef {{ path: string, file: File }} Item  path: relative to what was dropped, with forward slashes */

/** Files of an <input>, as items. */
export function itemsOfInput(input) {
  return [...input.files].map((file) => ({ path: file.webkitRelativePath || file.name, file }));
}

/**
 * Files of a drop, folders opened. The transfer is emptied as soon as the event handler returns: everything is taken
 * from it before the first await.
 * @param {DataTransfer} transfer
 * @return {Promise<Item[]>}
 */
export async function itemsOfDrop(transfer) {
  const entries = [];
  const items = [];
  for (const item of transfer.items) {
    if (item.kind !== 'file') continue;
    const entry = item.webkitGetAsEntry?.();
    if (entry?.isDirectory) {
      entries.push(entry);
    } else {
      const file = item.getAsFile();
      if (file) items.push({ path: file.name, file });
    }
  }
  while (entries.length > 0) {
    const folder = entries.shift();
    for (const entry of await readFolder(folder)) {
      if (entry.isDirectory) {
        entries.push(entry);
      } else {
        const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
        items.push({ path: entry.fullPath.replace(/^\//, ''), file });
      }
      if (items.length > MAX_FILES) throw new RangeError(`more than ${MAX_FILES} files`);
    }
  }
  return items;
}

/** All entries of a folder: the reader hands them out in portions of about a hundred. */
async function readFolder(folder) {
  const reader = folder.createReader();
  const entries = [];
  for (;;) {
    const portion = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (portion.length === 0) return entries;
    entries.push(...portion);
    if (entries.length > MAX_FILES) throw new RangeError(`more than ${MAX_FILES} files`);
  }
}

export const baseName = (path) => path.slice(path.lastIndexOf('/') + 1);

/** A URI of a glTF as a file's name. */
export function decodedUri(uri) {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
}

const PNG = [0x89, 0x50, 0x4e, 0x47];
const startsWith = (bytes, values) => values.every((value, i) => bytes[i] === value);

/**
 * What one file is: "model", "key", "picture" or "other", and for a glTF the names of the pictures it uses.
 * Damaged files count as what their name says, so that reading them tells what is wrong.
 */
async function classify({ file }) {
  const head = new Uint8Array(await file.slice(0, SNIFF_BYTES).arrayBuffer());
  const text = new TextDecoder().decode(head).replace(/^\ufeff/, '').trimStart();
  if (text.startsWith('glTF') || text.startsWith('DRACO') || /^ply\s/.test(text)) return { kind: 'model' };
  if (startsWith(head, PNG)) return { kind: 'picture' };
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
  if (extension === 'json') return { kind: 'key' };
  if (extension === 'png') return { kind: 'picture' };
  return { kind: 'other' };
}

/**
 * Sorts items into the page's slots.
 * @param {Item[]} items
 * @return {Promise<{ model?: Item, key?: Item, reference?: Item, parts: Item[], notices: string[] }>}
 *         parts: possible external buffers of a glTF; notices: sentences on what was not taken, and why
 */
export async function sortItems(items) {
  const notices = [];
  const kinds = { model: [], key: [], picture: [], other: [] };
  const textures = new Set();
  for (const item of items) {
    try {
      const { kind, textures: used = [] } = await classify(item);
      kinds[kind].push(item);
      for (const uri of used) textures.add(baseName(uri));
    } catch (error) {
      notices.push(`${item.path} could not be opened (${error.message}).`);
    }
  }
  const parts = [...kinds.other];
  const pictures = [];
  for (const item of kinds.picture) (textures.has(baseName(item.path)) ? parts : pictures).push(item);

  const one = (list, what) => {
    if (list.length > 1) {
      const names = list.slice(0, 3).map(({ path }) => path).join(', ') + (list.length > 3 ? ', …' : '');
      notices.push(`${list.length} ${what} at once (${names}): give one at a time.`);
    }
    return list.length === 1 ? list[0] : undefined;
  };
  const model = one(kinds.model, 'models');
  const key = one(kinds.key, 'key files');
  const inFolder = ({ path }) => path.includes('/');
  const reference = pictures.length > 1 && pictures.every(inFolder) ? undefined : one(pictures, 'PNG pictures');
  return { model, key, reference, parts, notices };
}

/**
 * Tells files that may be buffers of a glTF from those that are of no use.
 * @param model  the model of the same drop, if any
 * @return {{ parts: Item[], notices: string[] }}  notices: a sentence on each useless file that did not come in a folder
 */
export function splitStrangers(items, model) {
  if (model && !/\.(glb|ply|drc)$/i.test(model.path)) return { parts: items, notices: [] };
  const mayBePart = ({ path }) => /\.bin$/i.test(path);
  return {
    parts: items.filter(mayBePart),
    notices: items.filter((item) => !mayBePart(item) && !item.path.includes('/'))
      .map(({ path }) => `${path} was left aside: it is neither a model (GLB, glTF, PLY, DRC), nor a key file, nor a PNG picture.`),
  };
}

/**
 * The item that a glTF means by `uri`: the same path beside it, else the only file of that name.
 * @param {string} uri        as the glTF spells it
 * @param {string} modelPath
 * @param {Item[]} parts
 */
export function findPart(uri, modelPath, parts) {
  const wanted = decodedUri(uri).replace(/^(\.\/)+/, '');
  const folder = modelPath.slice(0, modelPath.lastIndexOf('/') + 1);
  const exact = parts.find(({ path }) => path === folder + wanted);
  if (exact) return exact;
  const named = parts.filter(({ path }) => baseName(path) === baseName(wanted));
  return named.length === 1 ? named[0] : undefined;
}
