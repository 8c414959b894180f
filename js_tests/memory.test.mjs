// SPDX-License-Identifier: MIT
// Nothing leaks: after a warm-up the module's memory does not grow, however many calls succeed or fail.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { createKey, embed, extract, inspect, memoryBytes } from 'quadmark';
import { logo, sculpture } from './support/marks.mjs';

const image = logo(8);

test('1000 embeds and 1000 failing calls do not grow the memory', async () => {
  const key = await createKey({ width: 8, height: 8 });
  const model = await sculpture('glb', 600);
  const cut = model.subarray(0, model.length - 40);
  const signal = () => {
    const controller = new AbortController();
    return { signal: controller.signal, onProgress: () => controller.abort() };
  };
  const failing = [
    () => embed(cut, { key, image }),
    () => embed(model, { key, image: logo(9) }),
    () => embed(model, { key: '{', image }),
    () => embed(model, { key, image, options: signal() }),
    () => extract(cut, { key }),
    () => extract(model, { key, options: { onProgress() { throw new Error('mine'); } } }),
    () => inspect(new Uint8Array(5)),
  ];
  const round = async (count) => {
    for (let i = 0; i < count; ++i) {
      const { bytes } = await embed(model, { key, image });
      if (i % 10 === 0) await extract(bytes, { key });
      await assert.rejects(failing[i % failing.length]());
    }
  };
  await round(50);
  const warm = memoryBytes();
  await round(950);
  assert.equal(memoryBytes(), warm);
});

test('a large call grows the memory and unload gives it back', async () => {
  const { unload } = await import('quadmark');
  const key = await createKey({ width: 8, height: 8 });
  const small = memoryBytes();
  await embed(await sculpture('glb', 100000), { key, image });
  assert.ok(memoryBytes() > small);
  unload();
  assert.equal(memoryBytes(), 0);
  await inspect(await sculpture('glb', 600));
  assert.ok(memoryBytes() <= small);
});
