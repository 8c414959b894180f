// SPDX-License-Identifier: MIT
// Models on disks that several machines share. Names are relative to a root, and never lead out of it; what is written
// appears complete under its name, and survives a power cut once it does.
import { randomBytes } from 'node:crypto';
import { mkdir, open, readdir, readFile, rename, rm } from 'node:fs/promises';
import { basename, dirname, join, relative, resolve, sep } from 'node:path';
import { externalUris, QuadmarkError } from 'quadmark';

/** An exception of node:fs as a QuadmarkError. */
export const ioError = (what, cause) => new QuadmarkError('io', `${what}: ${cause.code ?? cause.message}`, { cause });

/** Path of `name` below `root`; fails with `bad_option` for names that lead out of it. */
export function inside(root, name) {
  const path = resolve(root, name);
  if (name.includes('\0') || !path.startsWith(resolve(root) + sep)) {
    throw new QuadmarkError('bad_option', `${JSON.stringify(name)} does not lie below ${root}`);
  }
  return path;
}

/** Fails with `bad_option` where outputs would be inputs of the next run, or inputs be overwritten. */
export function checkRoots(inRoot, outRoot) {
  const [from, to] = [resolve(inRoot), resolve(outRoot)];
  if (from === to || from.startsWith(to + sep) || to.startsWith(from + sep)) {
    throw new QuadmarkError('bad_option', `inputs (${inRoot}) and outputs (${outRoot}) must lie apart`);
  }
}

export async function readInput(path) {
  try {
    return await readFile(path);
  } catch (cause) {
    throw ioError(`cannot read ${path}`, cause);
  }
}

/**
 * A model with the buffers it needs, which must lie beside or below it.
 * @return { bytes, resources: { uri: bytes }, names: { uri: path relative to the root } }
 */
export async function readModel(root, name) {
  const path = inside(root, name);
  const bytes = await readInput(path);
  const resources = {}, names = {};
  for (const uri of await externalUris(bytes)) {
    let file;
    try {
      file = inside(dirname(path), decodeURIComponent(uri));
    } catch (cause) {
      const told = `${name}: external buffer ${JSON.stringify(uri)}: only files beside or below the glTF are read`;
      throw new QuadmarkError('unsupported_file', told, { cause });
    }
    resources[uri] = await readInput(file);
    names[uri] = relative(root, file);
  }
  return { bytes, resources, names };
}

async function syncDirectory(path) {
  const handle = await open(path, 'r');
  try {
    await handle.sync();
  } finally {
    await handle.close();
  }
}

const partPrefix = (path, tag) => `.${basename(path)}.${tag}.`;

/**
 * Writes a file under a temporary name, and renames it when its bytes are on the disk.
 * @param tag  in the temporary name, for removeParts()
 */
export async function writeDurably(path, bytes, tag) {
  const part = join(dirname(path), `${partPrefix(path, tag)}${randomBytes(6).toString('hex')}.part`);
  try {
    await mkdir(dirname(path), { recursive: true });
    const handle = await open(part, 'wx');
    try {
      await handle.writeFile(bytes);
      await handle.sync();
    } finally {
      await handle.close();
    }
    await rename(part, path);
    await syncDirectory(dirname(path));
  } catch (cause) {
    await rm(part, { force: true });
    throw ioError(`cannot write ${path}`, cause);
  }
}

/** Removes what processes that were killed while writing `path` left behind. */
export async function removeParts(path, tag) {
  const prefix = partPrefix(path, tag);
  const names = await readdir(dirname(path)).catch(() => []);
  for (const name of names) {
    if (name.startsWith(prefix) && name.endsWith('.part')) await rm(join(dirname(path), name), { force: true });
  }
}
