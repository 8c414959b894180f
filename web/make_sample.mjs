// SPDX-License-Identifier: MIT
// Makes the files behind "Try a sample" in public/sample/: a generated sculpture, marked, damaged and untouched, with
// its key and logo. All made by our own code; nothing here is kept under version control.
import { createHash } from 'node:crypto';
import { mkdirSync, writeFileSync } from 'node:fs';
import { embed, encodeImage, extract, parseKey } from 'quadmark';
import { attack, generate } from 'quadmark/lab';
import { drawEmblem } from '../scripts/support/emblem.mjs';

const SIZE = 32;
const folder = new URL('./public/sample/', import.meta.url);

// A key that everybody has: its secret is the hash of a sentence, so that each build makes the same files.
const key = await parseKey({
  quadmark: 1,
  scheme: 'paper',
  secret: createHash('sha256').update('the public sample key of quadmark').digest('base64'),
  owner: 'quadmark sample',
  params: { L1: 2, H1: 4, L2: 2, H2: 3, lambda: 1e-3, tau: 1e-3, k: 1, width: SIZE, height: SIZE },
});
const logo = drawEmblem(SIZE);
const { bytes: original } = await generate({ name: 'sculpture', vertices: 20000, format: 'glb' });
const { bytes: marked } = await embed(original, { key, image: logo });

// Four fifths cut off, turned, sheared, in another order, and roughened: some pixels are lost, the verdict is not.
let damaged = marked;
for (const step of [
  { kind: 'noise', amount: 1e-6 }, { kind: 'crop', amount: 0.8 }, { kind: 'affine', variant: 'CB' }, { kind: 'reorder', seed: 1 },
]) {
  damaged = (await attack(damaged, { ...step, format: 'glb' })).bytes;
}

for (const [name, model, expected] of [['marked', marked, 'match'], ['damaged', damaged, 'match'], ['unmarked', original, 'none']]) {
  const { verdict } = await extract(model, { key });
  if (verdict !== expected) throw new Error(`the sample ${name}.glb reads as "${verdict}", expected "${expected}"`);
}
mkdirSync(folder, { recursive: true });
const write = (name, content) => writeFileSync(new URL(name, folder), content);
write('marked.glb', marked);
write('damaged.glb', damaged);
write('unmarked.glb', original);
write('key.json', `${JSON.stringify(key, null, 2)}\n`);
write('logo.png', await encodeImage(logo));
