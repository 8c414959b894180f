// SPDX-License-Identifier: MIT
// Every real model: embeds and extracts, or is refused for its capacity (a bare .drc is only read); stays as valid as it
// was; is loaded by glTF-Transform and three; and looks as before.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { embed, extract, inspect } from 'quadmark';
import { attack } from 'quadmark/lab';
import { noChromium } from './support/chromium.mjs';
import { allRealModels, readImageFiles, readModelFiles } from './support/files.mjs';
import { readDocument, validatorErrors } from './support/gltf_readers.mjs';
import { assertLooksTheSame } from './support/looks.mjs';
import { fixedKey, logo } from './support/marks.mjs';
import { openThree } from './support/three.mjs';

const three = noChromium ? null : await openThree({ after });

// Its pattern is about as fine as a pixel, so that it shows how vertices slide along the cloth: 1.8 % of the pixels at the
// default digits, 0.2 % one digit further down.
const FINER = { 'SheenCloth.glb': { L: 3 } };

/** The largest of a few logos that a model holds, as { key, image, marked }; null, after saying why, when none fits. */
async function mark(t, name, model, resources) {
  for (const size of [24, 8]) {
    const key = await fixedKey(size, FINER[name]), image = logo(size);
    try {
      return { key, image, marked: await embed(model, { key, image, resources }) };
    } catch (error) {
      assert.equal(error.code, 'capacity', `${name}: ${error.message}`);
      t.diagnostic(`${name}, ${size} x ${size} pixels: ${error.message}`);
    }
  }
  return null;
}

/** A model for three, which does not know the triangle strips of a PLY: as triangles with the same positions, if it must. */
async function forThree(model) {
  const strips = /^ply[^]*\nelement tristrips/.test(Buffer.from(model).toString('latin1', 0, 2000));
  return strips ? (await attack(model, { kind: 'reorder', format: 'ply' })).bytes : model;
}

const isGltf = (name) => /\.gl(b|tf)$/.test(name);

test('all real models', async (t) => {
  for (const { name, path } of allRealModels(t)) {
    await t.test(name, async (t) => {
      const { model, resources } = await readModelFiles(path);
      const { vertices } = await inspect(model, { resources });
      assert.ok(vertices > 0);
      if (name.endsWith('.drc')) {  // read, never written
        const key = await fixedKey(8);
        await assert.rejects(embed(model, { key, image: logo(8) }), { code: 'unsupported_file' });
        assert.equal((await extract(model, { key })).verdict, 'none');
        return;
      }
      const done = await mark(t, name, model, resources);
      if (!done) return;
      const { key, image, marked } = done;
      const files = { ...resources, ...marked.resources };
      const read = await extract(marked.bytes, { key, resources: files });
      assert.equal(read.verdict, 'match');
      assert.deepEqual(read.image.bits, image.bits);
      if (isGltf(name)) {
        assert.ok(await validatorErrors(marked.bytes, files) <= await validatorErrors(model, resources), 'validator errors');
        await readDocument(marked.bytes, files);
      }
      const seen = { ...resources, ...readImageFiles(path) };
      if (three) await assertLooksTheSame(t, three, name,
        { model: await forThree(model), resources: seen },
        { model: await forThree(marked.bytes), resources: { ...seen, ...files } });
      else t.diagnostic(`${noChromium}: how it looks was not tested`);
    });
  }
});
