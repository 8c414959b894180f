// SPDX-License-Identifier: MIT
// Entry `quadmark/vite`: marks the models of a build, those that are imported and those of the public folder.
import { existsSync, readFileSync, renameSync, writeFileSync } from 'node:fs';
import { readdir, readFile } from 'node:fs/promises';
import { dirname, extname, join, relative, resolve, sep } from 'node:path';
import { createFilter, normalizePath } from 'vite';
import { known } from '../arguments.js';
import { QuadmarkError } from '../error.js';
import { Store } from './store.js';
import { importsForUrls } from './urls.js';

const NAME = 'quadmark';

/** Documented in index.d.ts. */
export const QUADMARK_DEFAULTS = Object.freeze({
  include: Object.freeze(['**/*.glb', '**/*.gltf', '**/*.ply']), exclude: Object.freeze([]), dev: false, unmarkable: 'fail',
  strength: 'standard', salt: '',
});

const MARK = ['id', 'text', 'image'];
const EMBED_OPTIONS = ['strength', 'maxError', 'maxSlide', 'salt'];
const TYPES = { '.glb': 'model/gltf-binary', '.gltf': 'model/gltf+json', '.bin': 'application/octet-stream' };

const withoutQuery = (id) => id.replace(/[?#].*$/s, '');

function checkOptions(options) {
  known('quadmark', options, ['key', 'keyFile', 'include', 'exclude', 'dev', 'unmarkable', 'cacheDir', ...MARK, ...EMBED_OPTIONS]);
  const refuse = (message) => { throw new QuadmarkError('bad_option', `quadmark: ${message}`); };
  if (MARK.filter((name) => options[name] != null).length !== 1) refuse('give exactly one of image, id and text');
  if (options.key != null && options.keyFile != null) refuse('give key or keyFile, not both');
  if (options.unmarkable !== undefined && !['fail', 'warn'].includes(options.unmarkable)) refuse('unmarkable: expected "fail" or "warn"');
  if (options.dev !== undefined && typeof options.dev !== 'boolean') refuse('dev: expected true or false');
  return { ...QUADMARK_DEFAULTS, ...options };
}

/** Documented in index.d.ts. */
export function quadmark(given) {
  const options = checkOptions(given);
  let config, matches, store, cacheDir;
  const logged = new Set();

  const nameOf = (file) => normalizePath(relative(config.root, file));
  const inFolder = (file, folder) => file.startsWith(folder + sep);
  const isModel = (file) => matches(file) && !inFolder(file, cacheDir);
  const log = (file, what, level = 'info') => {
    const line = `${NAME}: ${nameOf(file)}: ${what}`;
    if (!logged.has(line)) config.logger[level](line);  // Vite may load a file for several environments
    logged.add(line);
  };

  function markFor(file) {
    const of = (value) => (typeof value === 'function' ? value(nameOf(file)) : value);
    const mark = {}, embedOptions = {};
    for (const name of ['id', 'text']) if (options[name] != null) mark[name] = of(options[name]);
    if (options.image != null) mark.image = typeof options.image === 'string' ? readFileSync(resolve(config.root, options.image)) : options.image;
    for (const name of EMBED_OPTIONS) if (given[name] !== undefined) embedOptions[name] = name === 'salt' ? of(given[name]) : given[name];
    return { ...mark, options: embedOptions };
  }

  /** The marked form of a file, or null where it cannot carry a mark and that is allowed. */
  async function marked(file, how) {
    try {
      const result = await store.marked(file, markFor(file), how);
      log(file, result.summary);
      for (const warning of result.warnings ?? []) log(file, warning, 'warn');
      return result;
    } catch (error) {
      if (options.unmarkable === 'warn' && ['capacity', 'bad_mesh'].includes(error.code)) {
        log(file, `not marked: ${error.message}`, 'warn');
        return null;
      }
      throw error.code ? new QuadmarkError(error.code, `${nameOf(file)}: ${error.message}`, { cause: error }) : error;
    }
  }

  const publicModels = async () => {
    const folder = config.publicDir;
    if (!folder || !existsSync(folder)) return [];
    return (await readdir(folder, { recursive: true })).map((name) => join(folder, name)).filter(isModel).sort();
  };

  const load = {
    name: `${NAME}:load`,
    enforce: 'pre',
    apply: (_, { command }) => command === 'build' || options.dev,

    config: () => ({ assetsInclude: [...options.include] }),

    configResolved(resolved) {
      config = resolved;
      matches = createFilter(options.include, options.exclude, { resolve: config.root });
      cacheDir = resolve(config.root, options.cacheDir ?? join(config.cacheDir, 'quadmark'));
      const keyFile = options.keyFile ?? (options.key == null ? process.env.QUADMARK_KEY_FILE : undefined);
      if (options.key == null && !keyFile) throw new QuadmarkError('bad_option', 'quadmark: no key: give keyFile or key, or set QUADMARK_KEY_FILE');
      let key = options.key;
      if (keyFile) {
        try {
          key = readFileSync(resolve(config.root, keyFile));
        } catch (cause) {
          throw new QuadmarkError('io', `quadmark: cannot read the key ${keyFile}: ${cause.message}`, { cause });
        }
      }
      store = new Store(cacheDir, key);
    },

    /** An imported model is one of the cache: Vite does the rest with that file, names and hashes included. */
    async load(id) {
      const file = withoutQuery(id);
      const query = id.slice(file.length);
      if (id.startsWith('\0') || /[?&]raw\b/.test(query) || !isModel(file) || !existsSync(file)) return null;
      if (config.publicDir && inFolder(file, config.publicDir)) return null;
      this.addWatchFile(file);
      const result = await marked(file);
      if (result === null) return null;
      const target = normalizePath(relative(dirname(file), result.path));
      return `export { default } from ${JSON.stringify(`${target.startsWith('.') ? target : `./${target}`}${query || '?url'}`)};`;
    },

    /** What HTML and CSS refer to is emitted past load(); its name was made of the unmarked bytes and stays. */
    async generateBundle(_, bundle) {
      for (const asset of Object.values(bundle)) {
        if (asset.type !== 'asset') continue;
        const file = (asset.originalFileNames ?? []).map((name) => resolve(config.root, name)).find((name) => isModel(name) && existsSync(name));
        if (file === undefined || !readFileSync(file).equals(Buffer.from(asset.source))) continue;
        const result = await marked(file);
        if (result === null) continue;
        asset.source = await readFile(result.path);
        log(file, `marked as ${asset.fileName}, a name made of the unmarked file: refer to it from a module`, 'warn');
      }
    },

    /** Vite has copied the public folder by now; these names have no hash, so the files are replaced where they are. */
    writeBundle: {
      order: 'post',
      sequential: true,
      async handler({ dir }) {
        if (!dir || !config.build.copyPublicDir) return;
        const written = new Map();
        const replace = (source, path) => {
          const target = join(dir, relative(config.publicDir, source));
          if (!existsSync(target)) return;
          const bytes = readFileSync(path);
          if (written.has(target) && !written.get(target).equals(bytes)) {
            throw new QuadmarkError('unsupported_file', `${nameOf(source)}: two models share this buffer and would mark it differently; make them .glb`);
          }
          written.set(target, bytes);
          writeFileSync(`${target}.tmp`, bytes);
          renameSync(`${target}.tmp`, target);
        };
        for (const file of await publicModels()) {
          if (!existsSync(join(dir, relative(config.publicDir, file)))) continue;
          const result = await marked(file, { buffers: true });
          if (result === null) continue;
          replace(file, result.path);
          for (const { source, path } of result.buffers) replace(source, path);
        }
      },
    },

    /** With `dev`: the public folder's models, marked when first asked for. */
    configureServer(server) {
      const buffers = new Map();  // file in the public folder -> its marked form
      server.middlewares.use(async (request, response, next) => {
        try {
          const path = decodeURIComponent(withoutQuery(request.url ?? ''));
          if (!config.publicDir || !path.startsWith(config.base)) return next();
          const file = join(config.publicDir, path.slice(config.base.length));
          if (!inFolder(file, config.publicDir) || !existsSync(file)) return next();
          const result = isModel(file) ? await marked(file, { buffers: true }) : null;
          for (const buffer of result?.buffers ?? []) buffers.set(buffer.source, buffer.path);
          const served = result?.path ?? buffers.get(file);
          if (served === undefined) return next();
          response.setHeader('Content-Type', TYPES[extname(file)] ?? 'application/octet-stream');
          response.setHeader('Cache-Control', 'no-cache');
          response.end(await readFile(served));
        } catch (error) {
          next(error);
        }
      });
    },
  };

  const urls = {
    name: `${NAME}:urls`,
    apply: load.apply,
    /** new URL('./model.glb', import.meta.url) becomes an import, so that load() sees it too. */
    transform(code, id) {
      if (!code.includes('import.meta.url') || !code.includes('new URL') || id.includes('/.vite/')) return null;
      return importsForUrls(this.parse(code), code, (url) => isModel(resolve(dirname(withoutQuery(id)), withoutQuery(url))));
    },
  };
  return [load, urls];
}
