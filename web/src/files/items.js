// SPDX-License-Identifier: MIT
// What the user dropped or chose, folders opened, as items.
import { t } from '../words/language.js';

/** More than this in one drop is somebody's whole disk. */
export const MAX_FILES = 2000;

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
      if (items.length > MAX_FILES) throw new RangeError(t('tooManyFiles', MAX_FILES));
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
    if (entries.length > MAX_FILES) throw new RangeError(t('tooManyFiles', MAX_FILES));
  }
}
