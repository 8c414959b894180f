// SPDX-License-Identifier: MIT
// Paths of items, and the buffers that a glTF means by its URIs.

export const baseName = (path) => path.slice(path.lastIndexOf('/') + 1);
export const folderOf = (path) => path.slice(0, path.lastIndexOf('/') + 1);
/** "a/b.c.glb" -> "b.c" */
export const stemOf = (path) => baseName(path).replace(/\.[^.]*$/, '');

/** A URI of a glTF as a file's name. */
export function decodedUri(uri) {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
}

/**
 * The item that a glTF means by `uri`: the same path beside it, else the only file of that name.
 * @param {string} uri        as the glTF spells it
 * @param {string} modelPath
 * @param {Item[]} parts
 */
export function findPart(uri, modelPath, parts) {
  const wanted = decodedUri(uri).replace(/^(\.\/)+/, '');
  const exact = parts.find(({ path }) => path === folderOf(modelPath) + wanted);
  if (exact) return exact;
  const named = parts.filter(({ path }) => baseName(path) === baseName(wanted));
  return named.length === 1 ? named[0] : undefined;
}
