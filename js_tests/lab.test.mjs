// SPDX-License-Identifier: MIT
// quadmark/lab: attacks and generated models.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { inspect } from 'quadmark';
import { attack, attackKinds, generate } from 'quadmark/lab';
import { quadmark } from './support/files.mjs';

const model = (await generate({ name: 'sculpture', vertices: 3000 })).bytes;

test('generated models are deterministic and readable', async () => {
  const again = (await generate({ name: 'sculpture', vertices: 3000 })).bytes;
  assert.equal(Buffer.compare(Buffer.from(model), Buffer.from(again)), 0);
  const other = await generate({ name: 'sculpture', vertices: 3000, seed: 2 });
  assert.notEqual(Buffer.compare(Buffer.from(model), Buffer.from(other.bytes)), 0);
  for (const format of ['ply', 'glb']) {
    const { bytes, vertices } = await generate({ name: 'part', vertices: 2000, format });
    const report = await inspect(bytes);
    assert.equal(report.format, format);
    assert.equal(report.vertices, vertices);
  }
});

test('every kind of attack does something and says what', async () => {
  const requests = {
    affine: { variant: 'NS' }, reorder: {}, crop: { amount: 0.3 }, noise: { amount: 1e-3 }, 'local-noise': { amount: 1e-3 },
    quantize: { amount: 12, variant: 'common' }, smooth: { amount: 0.1, variant: 'taubin', iterations: 2 },
    simplify: { amount: 0.3, variant: 'meshopt' }, deform: { amount: 0.5 },
  };
  const kinds = (await attackKinds()).map(({ kind, description }) => {
    assert.ok(description.length > 10);
    return kind;
  });
  assert.deepEqual(kinds.sort(), Object.keys(requests).sort());
  for (const kind of kinds) {
    const { bytes, before, after } = await attack(model, { kind, ...requests[kind] });
    assert.ok(Math.abs(before.vertices - 3000) < 300);
    assert.notEqual(Buffer.compare(Buffer.from(bytes), Buffer.from(model)), 0, kind);
    assert.equal((await inspect(bytes)).vertices, after.vertices);
    if (kind === 'crop') assert.ok(Math.abs(after.vertices / before.vertices - 0.7) < 0.01);
    if (kind === 'simplify') assert.ok(after.faces < 0.75 * before.faces);
  }
});

test('the help of the command line lists every kind', async () => {
  const { stdout } = await quadmark(['attack', '--help']);
  for (const { kind } of await attackKinds()) assert.match(stdout.toString(), new RegExp(`^  ${kind} `, 'm'));
});
