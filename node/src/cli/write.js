// SPDX-License-Identifier: MIT
// Writing: every file goes to a temporary name beside its target and is renamed when all are complete, so a failure
// leaves nothing half written. Nothing is overwritten without --force, and an input never.
import { closeSync, fsyncSync, linkSync, lstatSync, mkdirSync, openSync, realpathSync, renameSync, rmSync, statSync,
  writeFileSync } from 'node:fs';
import { randomBytes } from 'node:crypto';
import { basename, dirname, join, resolve } from 'node:path';
import { QuadmarkError } from '../error.js';
import { ioError } from './files.js';

const refuse = (message) => new QuadmarkError('io', message);

function statOrNull(path, stat = statSync) {
  try {
    return stat(path);
  } catch (error) {
    if (error.code === 'ENOENT') return null;
    throw ioError(`cannot write ${path}`, error);
  }
}

/** The real path of what does not exist yet, by its nearest existing directory. */
function realPathAhead(path) {
  const parent = dirname(resolve(path));
  return join(statOrNull(parent) ? realpathSync(parent) : realPathAhead(parent), basename(path));
}

/** Identifies a file whatever name or link leads to it. */
const identity = (stats) => `${stats.dev}:${stats.ino}`;

export class Writer {
  #force;
  #dryRun;
  #inputs = new Map();   // identity -> name
  #claimed = new Map();  // resolved target -> name of the input it was written for
  #promised = new Set(); // directories that a dry run has not made

  /**
   * @param options.force   existing files may be overwritten
   * @param options.dryRun  everything is checked, nothing is written
   * @param inputs          names of all files that are read in this run: none of them is ever written
   */
  constructor({ force, dryRun }, inputs) {
    this.#force = Boolean(force);
    this.#dryRun = Boolean(dryRun);
    for (const name of inputs) this.protect(name);
  }

  protect(name) {
    if (name === '-') return;
    const stats = statOrNull(name);
    if (stats) this.#inputs.set(identity(stats), name);
  }

  /**
   * Fails where `path` may not be written, before any work is done.
   * @param input             the input it is written for, for messages
   * @param makesDirectories  missing directories are no failure: the caller will make them
   * @return the path to write to: symbolic links to an existing file are followed.
   */
  check(path, input, { makesDirectories = false } = {}) {
    if (path === '-') return path;
    const parent = statOrNull(dirname(path));
    if (parent === null && (makesDirectories || this.#dryRun && this.#promised.has(resolve(dirname(path))))) return this.#claim(path, realPathAhead(path), input);
    if (!parent?.isDirectory()) throw refuse(`cannot write ${path}: ${dirname(path)} is not a directory`);
    const link = statOrNull(path, lstatSync);
    const stats = link && statOrNull(path);
    const target = stats ? realpathSync(path) : resolve(realpathSync(dirname(path)), basename(path));
    if (stats && this.#inputs.has(identity(stats))) {
      throw refuse(`cannot write ${path}: it is the input ${this.#inputs.get(identity(stats))} itself`);
    }
    if (stats?.isDirectory()) throw refuse(`cannot write ${path}: is a directory`);
    if (stats && !stats.isFile()) throw refuse(`cannot write ${path}: not a regular file (use - for standard output)`);
    if (link && !this.#force) throw refuse(`cannot write ${path}: already exists (--force overwrites)`);
    return this.#claim(path, target, input);
  }

  #claim(path, target, input) {
    if (this.#claimed.has(target)) {
      throw refuse(`cannot write ${path}: the output for ${this.#claimed.get(target)} of the same run goes there too`);
    }
    this.#claimed.set(target, input);
    return target;
  }

  /**
   * Writes all files or none.
   * @param files  [{ path, bytes, mode? }]; paths as check() returned them; "-" is standard output
   */
  writeAll(files) {
    if (this.#dryRun) return;
    const temporary = [];
    const placed = [];
    try {
      for (const { path, bytes, mode } of files) {
        if (path === '-') continue;
        const name = join(dirname(path), `.${basename(path)}.${randomBytes(6).toString('hex')}.tmp`);
        const handle = attempt(path, () => openSync(name, 'wx', mode ?? 0o666));
        temporary.push(name);
        try {
          attempt(path, () => {
            writeFileSync(handle, bytes);
            fsyncSync(handle);
          });
        } finally {
          closeSync(handle);
        }
      }
      const targets = files.filter(({ path }) => path !== '-');
      targets.forEach(({ path }, index) => {
        attempt(path, () => this.#place(temporary[index], path));
        placed.push(path);
      });
    } catch (error) {
      if (!this.#force) for (const path of placed) rmSync(path, { force: true });
      throw error;
    } finally {
      for (const name of temporary) rmSync(name, { force: true });
    }
    for (const { path, bytes } of files) if (path === '-') writeStandardOutput(bytes);
  }

  /** Makes a directory for outputs, with its parents. */
  makeDirectory(path) {
    if (this.#dryRun) {
      this.#promised.add(resolve(path));
      return;
    }
    try {
      mkdirSync(path, { recursive: true });
    } catch (error) {
      throw ioError(`cannot create the directory ${path}`, error);
    }
  }

  /** Renames; without --force in a way that fails when the target has appeared meanwhile. */
  #place(from, to) {
    if (!this.#force) {
      try {
        linkSync(from, to);
        return;
      } catch (error) {
        if (error.code === 'EEXIST') throw error;
        // A file system without hard links: check() was the best that can be done.
      }
    }
    renameSync(from, to);
  }
}

/** A pipe may take the bytes in parts and answer EAGAIN when it is full; writeFileSync(1) would give up there. */
function writeStandardOutput(bytes) {
  process.stdout.write(bytes);
}

function attempt(path, action) {
  try {
    return action();
  } catch (error) {
    throw error instanceof QuadmarkError ? error : ioError(`cannot write ${path}`, error);
  }
}
