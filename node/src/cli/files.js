// SPDX-License-Identifier: MIT
// Reading: files, standard input, and the external files of a glTF, which must lie beside or below it.
import { readFileSync, statSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { QuadmarkError } from '../error.js';
import { externalUris } from '../index_node.js';

const REASONS = {
  ENOENT: 'no such file or directory',
  EACCES: 'permission denied',
  EPERM: 'operation not permitted',
  EISDIR: 'is a directory',
  ENOTDIR: 'a part of the path is not a directory',
  ENOSPC: 'no space left',
  EROFS: 'the file system is read-only',
  EEXIST: 'already exists',
};

/** An exception of node:fs as a QuadmarkError. */
export function ioError(what, error) {
  if (error.code === 'ERR_FS_FILE_TOO_LARGE') return new QuadmarkError('too_large', `${what}: larger than 2 GiB`, { cause: error });
  return new QuadmarkError('io', `${what}: ${REASONS[error.code] ?? error.message}`, { cause: error });
}

export const displayName = (name) => (name === '-' ? 'standard input' : name);

/** Bytes of a file, or of standard input for "-". */
export async function readInput(name, what = 'cannot read') {
  try {
    if (name === '-') return Buffer.concat(await process.stdin.toArray());
    if (statSync(name).isDirectory()) throw Object.assign(new Error(), { code: 'EISDIR' });
    return readFileSync(name);
  } catch (error) {
    throw ioError(`${what} ${displayName(name)}`, error);
  }
}

/** Passes on what `work` gives; failures with one of `codes` get the name of the file that they speak of. */
export async function naming(name, codes, work) {
  try {
    return await work;
  } catch (error) {
    if (name === undefined || !codes.includes(error.code)) throw error;
    throw new QuadmarkError(error.code, `${displayName(name)}: ${error.message}`, { cause: error });
  }
}

/**
 * Relative path of a URI found in a file, or null for what is not followed: URLs (data: too), absolute paths, anything
 * that climbs out by "..", and names that hide such things behind %-escapes or backslashes.
 */
export function safeRelativePath(uri) {
  let path;
  try {
    path = decodeURIComponent(uri);
  } catch {
    return null;
  }
  if (/^[a-z][a-z0-9+.-]*:/i.test(path) || /^[/\\]/.test(path) || path.includes('\0')) return null;
  const segments = path.split(/[/\\]/);
  if (path.includes('\\') || segments.includes('..') || segments.at(-1) === '') return null;
  return segments.filter((segment) => segment !== '.').join('/') || null;
}

/** External image URIs of a .gltf; nothing for other files. Only for copying them beside the output. */
function imageUris(bytes) {
  if (!/^(\xef\xbb\xbf)?\s*\{/.test(bytes.subarray(0, 64).toString('latin1'))) return [];
  try {
    const { images } = JSON.parse(bytes.toString('utf8'));
    return images.map((image) => image.uri).filter((uri) => typeof uri === 'string');
  } catch {
    return [];  // not JSON or no images: the core has the last word on that
  }
}

/**
 * Reads a model and the external buffers it needs.
 * @return { name, bytes, resources: { uri: bytes }, paths: Map uri -> path, images: Map uri -> path of image files }
 */
export async function readModelFile(name) {
  const bytes = await readInput(name);
  const uris = await externalUris(bytes);
  if (name === '-' && uris.length > 0) {
    throw new QuadmarkError('bad_option', `the glTF refers to ${JSON.stringify(uris[0])}: give it by its file name, not on standard input`);
  }
  const paths = new Map();
  const resources = {};
  for (const uri of uris) {
    const relative = safeRelativePath(uri);
    if (relative === null) {
      throw new QuadmarkError('unsupported_file', `external buffer ${JSON.stringify(uri)}: only files beside or below the glTF are read`);
    }
    const path = join(dirname(name), relative);
    resources[uri] = await readInput(path, `external buffer ${JSON.stringify(uri)}: cannot read`);
    paths.set(uri, path);
  }
  const images = new Map();
  for (const uri of name === '-' ? [] : imageUris(bytes)) {
    const relative = safeRelativePath(uri);
    if (relative !== null) images.set(uri, join(dirname(name), relative));
  }
  return { name, bytes, resources, paths, images };
}
