// SPDX-License-Identifier: MIT
// Makes the files behind "Try a sample" in samples/: a generated sculpture, marked, damaged and untouched, with its
// key, another key and the logo. All made by our own code; nothing here is kept under version control.
import { createHash } from 'node:crypto';
import { mkdirSync, writeFileSync } from 'node:fs';
import { embed, encodeImage, extract, parseKey } from 'quadmark';
import { attack, generate } from 'quadmark/lab';
import { drawEmblem } from '../scripts/support/emblem.mjs';

const SIZE = 24;
const folder = new URL('./samples/', import.meta.url);

// Keys that everybody has: their secrets are hashes of sentences, so that each build makes the same files.
const sampleKey = (sentence, owner) => parseKey({
  quadmark: 1, scheme: 'robust', secret: createHash('sha256').update(sentence).digest('base64'), owner,
});
const key = await sampleKey('the public sample key of quadmark', 'quadmark sample');
const wrongKey = await sampleKey('another public sample key of quadmark', 'somebody else');
const logo = drawEmblem(SIZE);
const { bytes: original } = await generate({ name: 'sculpture', vertices: 20000, format: 'glb' });
const { bytes: marked } = await embed(original, { key, image: logo });

// Half cut off, turned, sheared, in another order, and roughened: some pixels are wrong, the verdict is not.
let damaged = marked;
for (const step of [
  { kind: 'noise', amount: 1.8e-4 }, { kind: 'crop', amount: 0.5 }, { kind: 'affine', variant: 'R' }, { kind: 'reorder', seed: 1 },
]) {
  damaged = (await attack(damaged, { ...step, format: 'glb' })).bytes;
}

for (const [name, model, read, expected] of [
  ['marked', marked, key, 'match'], ['damaged', damaged, key, 'match'], ['unmarked', original, key, 'none'], ['marked', marked, wrongKey, 'none'],
]) {
  const { verdict } = await extract(model, { key: read });
  if (verdict !== expected) throw new Error(`the sample ${name}.glb reads as "${verdict}" with the key of ${read.owner}, expected "${expected}"`);
}
const shown = (await extract(damaged, { key, reference: await encodeImage(logo) })).report.ber;
if (!(shown > 0.01 && shown < 0.1)) throw new Error(`of the damaged sample's pixels ${shown} are wrong: too few or too many to show what damage does`);
mkdirSync(folder, { recursive: true });
const write = (name, content) => writeFileSync(new URL(name, folder), content);
write('marked.glb', marked);
write('damaged.glb', damaged);
write('unmarked.glb', original);
write('key.json', `${JSON.stringify(key, null, 2)}\n`);
write('wrong-key.json', `${JSON.stringify(wrongKey, null, 2)}\n`);
write('logo.png', await encodeImage(logo));
