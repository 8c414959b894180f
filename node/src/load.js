// SPDX-License-Identifier: MIT
// The life of one wasm module: fetched and compiled on first use, instantiated once, replaced after a trap.
import { QuadmarkError } from './error.js';

/** Turns what a caller or the platform offers as "the wasm" into a WebAssembly.Module; rejects on every failure. */
async function compile(source) {
  const given = await source;
  if (given instanceof WebAssembly.Module) return given;
  if (given instanceof ArrayBuffer || ArrayBuffer.isView(given)) return WebAssembly.compile(given);
  const response = typeof given === 'string' || given instanceof URL ? await fetch(given) : given;
  if (typeof response?.arrayBuffer !== 'function') {
    throw new TypeError('expected a URL, Response, bytes or WebAssembly.Module');
  }
  if (response.ok === false) throw new Error(`HTTP status ${response.status} for ${response.url}`);
  // Streaming needs the MIME type application/wasm, which plain file servers often do not send.
  const type = response.headers?.get('content-type') ?? '';
  if (/^application\/wasm\b/i.test(type)) return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}

/** Wraps whatever came out of a dead instance into a QuadmarkError. */
function describeCrash(error, memoryBytes) {
  const used = `${Math.round(memoryBytes / 2 ** 20)} MiB`;
  if (error instanceof RangeError && /memory|allocation/i.test(error.message)) {
    return new QuadmarkError('too_large', `out of memory: the module had ${used} when an allocation failed`, { cause: error });
  }
  const what = error instanceof Error ? error.message : `exception ${error}`;
  return new QuadmarkError('internal', `the wasm module failed (${what}); this is a bug in quadmark`, { cause: error });
}

export class Loader {
  #factory;
  #defaultSource;
  #compiled = null;  // promise of a WebAssembly.Module; kept for the next instance
  #ready = null;     // promise of { api, memory }
  #current = null;   // the settled value of #ready

  /**
   * @param factory        Emscripten's factory (options) => Promise<api>; it may import its glue first
   * @param defaultSource  () => source of the wasm, called at most once per successful compilation
   */
  constructor(factory, defaultSource) {
    this.#factory = factory;
    this.#defaultSource = defaultSource;
  }

  /** Replaces the default source of what has not been compiled yet. */
  useSource(source) {
    Promise.resolve(source).catch(() => {});  // a failure is told when the source is used
    this.#defaultSource = () => source;
  }

  /** Compiles from `source` (default: the file of the package) and instantiates, unless that has happened already. */
  async load(source) {
    await this.#instance(source);
  }

  /** Frees the module's memory; the next call makes a new instance. */
  unload() {
    this.#ready = null;
    this.#current = null;
  }

  /** Bytes of wasm memory held now; 0 when nothing is instantiated. */
  get memoryBytes() {
    return this.#current?.memory.buffer.byteLength ?? 0;
  }

  /** Runs `use(api)`, synchronous code on the instance. Anything but a QuadmarkError coming out of it kills the instance. */
  async call(use) {
    const instance = await this.#instance();
    try {
      return use(instance.api);
    } catch (error) {
      if (error instanceof QuadmarkError) throw error;
      const crash = describeCrash(error, instance.memory.buffer.byteLength);
      if (this.#current === instance) this.unload();
      throw crash;
    }
  }

  #instance(source) {
    this.#ready ??= this.#instantiate(source).catch((error) => {
      this.#ready = null;  // a failed download may be tried again
      throw error instanceof QuadmarkError
        ? error
        : new QuadmarkError('io', `the wasm module could not be loaded: ${error.message}`, { cause: error });
    });
    return this.#ready;
  }

  async #instantiate(source) {
    this.#compiled ??= compile(source ?? this.#defaultSource()).catch((error) => {
      this.#compiled = null;
      throw error;
    });
    const module = await this.#compiled;
    let memory;
    const api = await new Promise((resolve, reject) => {
      this.#factory({
        // The glue waits for ever when its own loading fails: this hook does the loading, and rejects.
        instantiateWasm(imports, receive) {
          WebAssembly.instantiate(module, imports).then((instance) => {
            memory = Object.values(instance.exports).find((item) => item instanceof WebAssembly.Memory);
            receive(instance, module);
          }).catch(reject);
          return {};
        },
        print() {},
        printErr() {},
        onAbort: (reason) => reject(new Error(String(reason))),
      }).then(resolve, reject);
    });
    const instance = { api, memory };
    this.#current = instance;
    return instance;
  }
}
