// SPDX-License-Identifier: MIT
// What a page downloads before it can look at a model. Compressed sizes are a promise (docs/design.md, section 6).
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { brotliCompressSync, constants } from 'node:zlib';

const limits = {
  'quadmark.wasm': 200_000, 'quadmark.js': 15_000, 'quadmark_draco.wasm': 230_000, 'quadmark_draco.js': 15_000,
};

for (const [name, limit] of Object.entries(limits)) {
  test(`${name} has at most ${limit / 1000} kB after brotli`, async (t) => {
    const bytes = await readFile(new URL(`../node/dist/${name}`, import.meta.url));
    const compressed = brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 11 } }).length;
    t.diagnostic(`${name}: ${bytes.length} bytes, ${compressed} compressed`);
    assert.ok(compressed <= limit, `${compressed} bytes`);
  });
}
