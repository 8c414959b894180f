// SPDX-License-Identifier: MIT
// The registry on disk. Lines are only ever added, each by one write that reaches the disk before the copy it speaks of
// gets its name: whatever is stopped when, every copy that exists is in the registry. A run that was killed in the middle
// of a line leaves it torn; the next one takes that away.
import { createHash } from 'node:crypto';
import { closeSync, existsSync, fstatSync, fsyncSync, ftruncateSync, openSync, readFileSync, rmSync, truncateSync, writeSync } from 'node:fs';
import { hostname } from 'node:os';
import { QuadmarkError } from '../error.js';
import { parseRegistry, registryLine } from '../registry.js';
import { ioError } from './files.js';

export const sha256 = (bytes) => createHash('sha256').update(bytes).digest('hex');

const markOf = ({ id, image, salt = '' }) => JSON.stringify([id ?? [image.width, image.height, ...image.bits], salt]);

/** Entries of the registry at `path`. */
export function readRegistry(path) {
  try {
    return parseRegistry(readFileSync(path, 'utf8'), path);
  } catch (error) {
    throw error instanceof QuadmarkError ? error : ioError(`cannot read the registry ${path}`, error);
  }
}

function isAlive(pid) {
  try {
    process.kill(pid, 0);
    return true;
  } catch (error) {
    return error.code === 'EPERM';
  }
}

/** Makes `path`.lock, which says who writes; one left by a process of this machine that is gone is taken over. */
function lock(path) {
  const name = `${path}.lock`;
  for (let attempt = 0; ; ++attempt) {
    try {
      const handle = openSync(name, 'wx');
      writeSync(handle, `${process.pid} ${hostname()}\n`);
      closeSync(handle);
      return name;
    } catch (error) {
      if (error.code !== 'EEXIST' || attempt > 0) throw ioError(`cannot lock the registry ${path}`, error);
      const [pid, host] = readFileSync(name, 'utf8').trim().split(' ');
      if (host !== hostname() || isAlive(Number(pid))) {
        throw new QuadmarkError('io', `the registry ${path} is in use by process ${pid} on ${host}; remove ${name} if that one is gone`);
      }
      rmSync(name, { force: true });
    }
  }
}

export class RegistryFile {
  #path;
  #handle = null;
  #lock = null;
  #entries = [];
  #key;

  /**
   * Opens, or makes with the first entry, the registry at `path` for adding.
   * @param key     fingerprint of the key that marks
   * @param dryRun  reads and checks alone
   */
  constructor(path, key, { dryRun = false } = {}) {
    this.#path = path;
    this.#key = key;
    if (!dryRun) this.#lock = lock(path);
    try {
      if (!existsSync(path)) return;
      const { entries, end } = readRegistry(path);
      this.#entries = entries.filter((entry) => entry.key === key);
      if (!dryRun) truncateSync(path, Buffer.byteLength(readFileSync(path, 'utf8').slice(0, end)));
    } catch (error) {
      this.close();
      throw error instanceof QuadmarkError ? error : ioError(`cannot open the registry ${path}`, error);
    }
  }

  /** Refuses a mark that another recipient has already. `where` names its place in the list. */
  claim(entry, where) {
    const other = this.#entries.find((old) => markOf(old) === markOf(entry) && old.recipient !== entry.recipient);
    if (other) {
      throw new QuadmarkError('bad_option', `${where}: ${JSON.stringify(entry.recipient)} would get the mark of ${JSON.stringify(other.recipient)}`);
    }
    this.#entries.push({ ...entry, claimed: true });
  }

  /** Whether this very copy was written and noted before. */
  has({ recipient, modelSha256, output, outputSha256 }) {
    return this.#entries.some((old) => old.recipient === recipient && old.modelSha256 === modelSha256 && old.output === output && old.outputSha256 === outputSha256);
  }

  /** Adds one entry, on disk when this returns. */
  add(entry) {
    if (this.#lock === null || this.has(entry)) return;
    const line = Buffer.from(registryLine({ ...entry, key: this.#key }));
    try {
      this.#handle ??= openSync(this.#path, 'a', 0o600);
      const { size } = fstatSync(this.#handle);
      try {
        for (let at = 0; at < line.length;) at += writeSync(this.#handle, line, at);
        fsyncSync(this.#handle);
      } catch (error) {
        ftruncateSync(this.#handle, size);
        throw error;
      }
    } catch (error) {
      throw ioError(`cannot write the registry ${this.#path}`, error);
    }
    this.#entries.push(entry);
  }

  close() {
    if (this.#handle !== null) closeSync(this.#handle);
    if (this.#lock !== null) rmSync(this.#lock, { force: true });
    this.#handle = this.#lock = null;
  }
}
