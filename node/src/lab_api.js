// SPDX-License-Identifier: MIT
// Calls of quadmark/lab over its Loader: attacks and generated models, for tests and demonstrations.
import { unwrap } from './api.js';
import { known, toBytes, toEntries } from './arguments.js';
import { QuadmarkError } from './error.js';

function toFormat(format) {
  if (format !== 'ply' && format !== 'glb') throw new QuadmarkError('bad_option', 'format: expected "ply" or "glb"');
  return format;
}

function toText(what, text) {
  if (typeof text !== 'string') throw new QuadmarkError('bad_option', `${what}: expected text`);
  return text;
}

export function createLab(loader) {
  return {
    async attack(model, request) {
      const { resources, kind, variant, format = 'ply', ...numbers } =
        known('request', request, ['resources', 'kind', 'amount', 'variant', 'iterations', 'seed', 'format']);
      const bytes = toBytes('model', model);
      const entries = toEntries(resources);
      const spec = { ...numbers, kind: toText('kind', kind), format: toFormat(format) };
      if (variant !== undefined) spec.variant = toText('variant', variant);
      return loader.call((api) => unwrap(api.attack(bytes, entries, spec)));
    },

    async generate(request) {
      const { name, format = 'ply', ...numbers } = known('request', request, ['name', 'vertices', 'seed', 'format']);
      const spec = { ...numbers, name: toText('name', name), format: toFormat(format) };
      return loader.call((api) => {
        const { bytes, after } = unwrap(api.generate(spec));
        return { bytes, ...after };
      });
    },

    async attackKinds() {
      return loader.call((api) => api.attackKinds());
    },

    async load(request = {}) {
      const { wasm } = known('request', request, ['wasm']);
      await loader.load(wasm);
    },

    unload() {
      loader.unload();
    },
  };
}
