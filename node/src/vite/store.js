// SPDX-License-Identifier: MIT
// Marked models by content: what was marked once under the same key and options is taken from the cache.
import { createHash, randomBytes } from 'node:crypto';
import { existsSync, mkdirSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { basename, dirname, join } from 'node:path';
import { readModelFile, safeRelativePath } from '../cli/files.js';
import { QuadmarkError } from '../error.js';
import { embed, keyFingerprint, parseKey, version } from '../index_node.js';

const PACKAGE = new URL('../../package.json', import.meta.url);
const digest = (...parts) => parts.reduce((hash, part) => hash.update(part), createHash('sha256')).digest('hex');

export class Store {
  #folder;
  #key;
  #jobs = new Map();  // name of an entry -> promise of it
  #queue = Promise.resolve();

  /**
   * @param folder  of the cache
   * @param key     anything parseKey() takes
   */
  constructor(folder, key) {
    this.#folder = folder;
    this.#key = (async () => {
      const parsed = await parseKey(key);
      const { version: ofPackage } = JSON.parse(await readFile(PACKAGE, 'utf8'));
      // Of the key its fingerprint and what is no secret: the name of an entry must not tell it.
      return { parsed, label: JSON.stringify([ofPackage, await version(), parsed.scheme, parsed.params ?? null, await keyFingerprint(parsed)]) };
    })();
    this.#key.catch(() => {});  // told by the first use
  }

  /**
   * The marked form of a file on disk.
   * @param file     its path
   * @param mark     { image | id | text, options } as embed() takes them; image: bytes of a PNG
   * @param options.buffers  whether a .gltf may have external buffers, marked beside it
   * @return { path, buffers: [{ path, source }], summary, cached }  paths in the cache; source: path of the buffer before
   */
  async marked(file, mark, { buffers = false } = {}) {
    const { parsed, label } = await this.#key;
    const model = await readModelFile(file);
    if (model.paths.size > 0 && !buffers) {
      throw new QuadmarkError('unsupported_file', `refers to ${JSON.stringify([...model.paths.keys()][0])}, which an imported file cannot bring along: make it a .glb, or put both into the public folder`);
    }
    const { image, ...plain } = mark;
    const spelled = JSON.stringify(plain, (_, value) => (typeof value === 'bigint' ? value.toString(16) : value));
    const resources = [...model.paths.keys()].sort().flatMap((uri) => [`\0${uri}\0`, digest(model.resources[uri])]);
    // The file's name too: Vite names what it emits after it.
    const name = digest(label, '\0', basename(file), '\0', spelled, '\0', image ?? '', '\0', digest(model.bytes), ...resources).slice(0, 32);
    const entry = join(this.#folder, name);
    const places = [...model.paths].map(([uri, source]) => ({ uri, source, path: join(entry, safeRelativePath(uri)) }));
    const result = { path: join(entry, basename(file)), buffers: places.map(({ source, path }) => ({ source, path })) };
    const work = async () => {
      if (existsSync(entry)) return { ...result, cached: true, summary: 'cached' };
      const { bytes, resources: changed, report } = await embed(model.bytes, { key: parsed, ...mark, resources: model.resources });
      this.#place(entry, [{ path: result.path, bytes }, ...places.map(({ uri, path }) => ({ path, bytes: changed[uri] ?? model.resources[uri] }))]);
      const { strength, distortion } = report;
      return { ...result, cached: false, summary: `marked${strength ? `, strength ${strength}` : ''}, SNR ${distortion.snrDb?.toFixed(1) ?? '?'} dB`, warnings: report.warnings };
    };
    // One at a time: the work is synchronous anyway, and equal files are marked once.
    if (!this.#jobs.has(name)) {
      const job = this.#queue.then(work);
      this.#jobs.set(name, job);
      this.#queue = job.catch(() => { this.#jobs.delete(name); });
    }
    return this.#jobs.get(name);
  }

  /** An entry appears whole or not at all, also when two builds make it at once. */
  #place(entry, files) {
    const temporary = `${entry}.${randomBytes(6).toString('hex')}.tmp`;
    try {
      for (const { path, bytes } of files) {
        const target = join(temporary, path.slice(entry.length));
        mkdirSync(dirname(target), { recursive: true });
        writeFileSync(target, bytes);
      }
      renameSync(temporary, entry);
    } catch (error) {
      rmSync(temporary, { recursive: true, force: true });
      if (!existsSync(entry)) throw error;
    }
  }
}
