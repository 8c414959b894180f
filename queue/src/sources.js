// SPDX-License-Identifier: MIT
// Where models come from: [{ input, output }], names relative to the roots.
import { readdir, readFile } from 'node:fs/promises';
import { join, posix, sep } from 'node:path';
import { ioError } from './files.js';

const MODEL = /\.(glb|gltf|ply)$/i;

const same = (name) => ({ input: name, output: name });

async function list(directory, options) {
  try {
    return await readdir(directory, options);
  } catch (cause) {
    throw ioError(`cannot list ${directory}`, cause);
  }
}

/** Models directly in a folder. */
export async function fromFolder(folder) {
  const entries = await list(folder, { withFileTypes: true });
  return entries.filter((entry) => entry.isFile() && MODEL.test(entry.name)).map(({ name }) => same(name)).sort(byInput);
}

/** Models anywhere below a folder that is laid out as a bucket: keys are paths, of which `prefix` picks some. */
export async function fromBucket(folder, prefix = '') {
  const entries = await list(folder, { withFileTypes: true, recursive: true });
  return entries.filter((entry) => entry.isFile() && MODEL.test(entry.name))
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name).slice(join(folder, sep).length).split(sep).join(posix.sep))
    .filter((name) => name.startsWith(prefix)).map(same).sort(byInput);
}

/** A text file with one name per line; empty lines and lines that begin with # are left out. */
export async function fromList(file) {
  let text;
  try {
    text = await readFile(file, 'utf8');
  } catch (cause) {
    throw ioError(`cannot read the list ${file}`, cause);
  }
  return text.split(/\r?\n/).map((line) => line.trim()).filter((line) => line !== '' && !line.startsWith('#')).map(same);
}

const byInput = (a, b) => (a.input < b.input ? -1 : 1);
