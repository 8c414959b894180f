// SPDX-License-Identifier: MIT
// The public calls over a Loader: they check types, convert plain data, and turn failures into QuadmarkError. What a
// value may be (ranges, sizes, formats) is the core's to decide.
import { toBytes, toEntries, toIdDigits, toImage, toKeyJson, toText, known, isObject } from './arguments.js';
import { needsDraco } from './draco.js';
import { QuadmarkError } from './error.js';

/** The scheme of keys that are made without naming one and without anything that only keys of scheme paper hold. */
export const DEFAULT_SCHEME = 'robust';

const PAPER_KEY_MEMBERS = ['width', 'height', 'id', 'L', 'H1', 'L1', 'H2', 'L2', 'lambda', 'tau', 'k', 'keyedCells', 'scrambleOrder'];

const LONG_CALL = ['onProgress', 'signal'];

/** Options of the robust scheme as the bindings take them; which keys they go with is the core's to decide. */
function robustOptions(options, names) {
  const given = {};
  for (const name of names) {
    const value = options?.[name];
    if (value === undefined) continue;
    if (name === 'selfTest' && typeof value !== 'boolean') {
      throw new QuadmarkError('bad_option', 'options.selfTest: expected true or false');
    }
    given[name] = name === 'salt' || name === 'strength' ? toText(`options.${name}`, value) : value;
  }
  return given;
}

/** The value of a binding, or its failure thrown. */
export function unwrap(result) {
  if (result.error) throw new QuadmarkError(result.error.code, result.error.message);
  return result;
}

function throwIfAborted(signal) {
  if (signal?.aborted) throw new QuadmarkError('aborted', 'cancelled by the caller', { cause: signal.reason });
}

/**
 * Runs a long call with progress and cancellation. An exception in the caller's onProgress must not unwind through
 * wasm frames (they would never clean up): it is held back, the core is told to stop, and it is thrown afterwards.
 */
async function runLong(loader, options, use) {
  const { onProgress, signal } = options ?? {};
  if (onProgress !== undefined && typeof onProgress !== 'function') {
    throw new QuadmarkError('bad_option', 'options.onProgress: expected a function');
  }
  if (signal !== undefined && typeof signal?.aborted !== 'boolean') {
    throw new QuadmarkError('bad_option', 'options.signal: expected an AbortSignal');
  }
  throwIfAborted(signal);
  let thrown;
  const progress = onProgress || signal
    ? (stage, done) => {
        try {
          onProgress?.({ stage, done });
        } catch (error) {
          thrown = { error };
          return false;
        }
        return !signal?.aborted;
      }
    : undefined;
  return loader.call((api) => {
    throwIfAborted(signal);
    const result = use(api, progress);
    if (result.error?.code === 'aborted') {
      if (thrown) return { thrown };
      throwIfAborted(signal);
    }
    return unwrap(result);
  }).then((result) => {
    if (result.thrown) throw result.thrown.error;
    return result;
  });
}

/**
 * Binds the calls to the module. Documented in index.d.ts.
 * @param loader       of the module that everything but Draco goes through
 * @param dracoLoader  of the same module with Draco's decoder, loaded for the first model that needs it
 */
export function createApi(loader, dracoLoader = loader) {
  const loaderFor = (model) => (needsDraco(model) ? dracoLoader : loader);
  return {
    async embed(model, request) {
      const { key, image, id, text, resources, options } =
        known('request', request, ['key', 'image', 'id', 'text', 'resources', 'options']);
      const names = ['strength', 'maxError', 'maxSlide', 'salt', 'selfTest'];
      known('options', options ?? {}, [...LONG_CALL, ...names]);
      if ([image, id, text].filter((given) => given != null).length !== 1) {
        throw new QuadmarkError('bad_option', 'embed: give exactly one of image, id and text');
      }
      const bytes = toBytes('model', model);
      const entries = toEntries(resources);
      const mark = robustOptions(options, names);
      if (image != null) mark.image = toImage('image', image);
      if (id != null) mark.id = toIdDigits(id);
      if (text != null) mark.text = toText('text', text);
      const keyJson = toKeyJson(key);
      const result = await runLong(loaderFor(bytes), options, (api, progress) =>
        api.embed(bytes, entries, { key: keyJson, ...mark, progress }));
      return {
        bytes: result.bytes,
        resources: Object.fromEntries(result.resources),
        report: JSON.parse(result.report),
      };
    },

    async extract(model, request) {
      const { key, reference, expectId, expectText, resources, options } =
        known('request', request, ['key', 'reference', 'expectId', 'expectText', 'resources', 'options']);
      known('options', options ?? {}, [...LONG_CALL, 'salt']);
      const bytes = toBytes('model', model);
      const entries = toEntries(resources);
      const expected = robustOptions(options, ['salt']);
      if (reference != null) expected.reference = toImage('reference', reference);
      if (expectId != null) expected.expectId = toIdDigits(expectId, 'expectId');
      if (expectText != null) expected.expectText = toText('expectText', expectText);
      const keyJson = toKeyJson(key);
      const result = await runLong(loaderFor(bytes), options, (api, progress) =>
        api.extract(bytes, entries, { key: keyJson, ...expected, progress }));
      return { ...result, report: JSON.parse(result.report) };
    },

    async inspect(model, request = {}) {
      const { resources } = known('request', request, ['resources']);
      const bytes = toBytes('model', model);
      const entries = toEntries(resources);
      return loaderFor(bytes).call((api) => JSON.parse(unwrap(api.inspect(bytes, entries)).report));
    },

    async externalUris(model) {
      const bytes = toBytes('model', model);
      return loader.call((api) => unwrap(api.externalUris(bytes)).uris);
    },

    async createKey(request = {}) {
      known('request', request, ['owner', 'scheme', ...PAPER_KEY_MEMBERS]);
      const forPaper = PAPER_KEY_MEMBERS.some((name) => request[name] !== undefined);
      const { owner = '', scheme = forPaper ? 'paper' : DEFAULT_SCHEME, id = false, ...params } = request;
      if (typeof owner !== 'string') throw new QuadmarkError('bad_option', 'owner: expected text');
      const secret = crypto.getRandomValues(new Uint8Array(32));
      const make = (core) => loader.call((api) => JSON.parse(unwrap(api.createKey({ ...core, secret, owner, scheme })).key));
      if (scheme === 'robust') {
        known('a key of scheme "robust"', request, ['owner', 'scheme']);
        return make({});
      }
      if (scheme !== 'paper') {
        throw new QuadmarkError('bad_option', `scheme ${JSON.stringify(scheme)} is not available in this version, only "paper" and "robust"`);
      }
      for (const name of ['keyedCells', 'scrambleOrder']) {
        if (params[name] !== undefined && typeof params[name] !== 'boolean') {
          throw new QuadmarkError('bad_option', `${name}: expected true or false`);
        }
      }
      if (typeof id !== 'boolean') throw new QuadmarkError('bad_option', 'id: expected true (a key for 64-bit IDs) or false');
      const hasSize = params.width !== undefined || params.height !== undefined;
      if (id === hasSize) throw new QuadmarkError('bad_option', 'createKey: give either width and height, or id: true');
      const digits = ['H1', 'L1', 'H2', 'L2'].filter((name) => params[name] !== undefined);
      if (digits.length !== 0 && digits.length !== 4) {
        throw new QuadmarkError('bad_option', `digit positions: ${digits.join(', ')} given, but H1, L1, H2, L2 go together`);
      }
      return make({ ...params, payload: id ? 'id' : 'image' });
    },

    async parseKey(key) {
      const json = toKeyJson(key);
      return loader.call((api) => JSON.parse(unwrap(api.parseKey(json)).key));
    },

    async decodeImage(png, request = {}) {
      const { threshold } = known('request', request, ['threshold']);
      if (threshold !== undefined && !(threshold >= 0 && threshold <= 1)) {
        throw new QuadmarkError('bad_option', 'threshold: expected a number from 0 to 1');
      }
      const bytes = toBytes('png', png);
      return loader.call((api) => unwrap(api.decodeImage(bytes, threshold ?? -1)).image);
    },

    async encodeImage(image) {
      if (!isObject(image) || image instanceof Uint8Array) {
        throw new QuadmarkError('bad_option', 'image: expected { width, height, bits }');
      }
      const erased = image.erased == null ? undefined : toBytes('image.erased', image.erased);
      const value = { ...toImage('image', image), erased };
      return loader.call((api) => unwrap(api.encodeImage(value)).png);
    },

    async version() {
      return loader.call((api) => api.version());
    },

    async load(request = {}) {
      const { wasm, dracoWasm } = known('request', request, ['wasm', 'dracoWasm']);
      if (dracoWasm !== undefined) dracoLoader.useSource(dracoWasm);
      await loader.load(wasm);
    },

    unload() {
      loader.unload();
      dracoLoader.unload();
    },

    memoryBytes() {
      return dracoLoader === loader ? loader.memoryBytes : loader.memoryBytes + dracoLoader.memoryBytes;
    },
  };
}
