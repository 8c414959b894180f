// SPDX-License-Identifier: MIT
// Native and wasm give the same bytes: generated models, attacks, marked files, and everything that is read back.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { test } from 'node:test';
import { createKey, embed, extract, inspect } from 'quadmark';
import { attack, generate } from 'quadmark/lab';
import { readModelFiles, realModels, repository, run, temporaryFolder } from './support/files.mjs';
import { logo, logoPng } from './support/marks.mjs';

const native = process.env.QUADMARK_NATIVE ?? join(repository, 'build/native/bench/quadmark_native');
const skip = existsSync(native) ? false : `${native} is not built (cmake --build --preset release)`;
const equal = (actual, expected, what) =>
  assert.equal(Buffer.compare(Buffer.from(actual), Buffer.from(expected)), 0, `${what}: native and wasm differ`);

/**
 * Equal reports. Three measures go through the C library's log and acos, whose last bit differs between platforms;
 * they are printed, and decide nothing.
 */
function assertSameReport(actual, expected, what) {
  const round = (report) => {
    const copy = structuredClone(report);
    for (const name of ['snrDb', 'normalPsnrDb', 'meanNormalDeg']) {
      const value = copy.distortion?.[name];
      if (typeof value === 'number') copy.distortion[name] = Number(value.toPrecision(10));
    }
    return copy;
  };
  assert.deepEqual(round(actual), round(expected), what);
}

async function runNative(...args) {
  const { status, json, stderr } = await run(native, args.map(String));
  assert.equal(status, 0, stderr || JSON.stringify(json));
  return json[0];
}

/**
 * Marks, damages and reads `path` natively and in wasm, comparing everything.
 * @param payload  { id } or { text } instead of a picture: for keys of scheme robust
 */
async function compare(t, path, { size = 24, L = 2, scheme = 'paper', payload, strength, attacks = [{ kind: 'crop', amount: 0.5 }] } = {}) {
  const folder = temporaryFolder(t);
  const name = basename(path);
  const image = logo(size);
  const key = await createKey(scheme === 'robust' ? { scheme } : { width: size, height: size, L });
  const mark = payload ?? { image };
  writeFileSync(join(folder, 'key.json'), JSON.stringify(key));
  writeFileSync(join(folder, 'logo.png'), logoPng(image));
  const { model, resources } = await readModelFiles(path);
  const nativeResources = Object.keys(resources).map((uri) => `${uri}=${join(dirname(path), decodeURIComponent(uri))}`);

  assert.deepEqual(await inspect(model, { resources }), await runNative('inspect', path, ...nativeResources), `${name}: inspect`);
  const out = join(folder, name);
  const nativeReport = await runNative('embed', path, out, join(folder, 'key.json'),
    ...(payload ? Object.entries(payload)[0] : ['image', join(folder, 'logo.png')]),
    ...(strength ? ['--strength', strength] : []), ...nativeResources);
  const marked = await embed(model, { key, ...mark, resources, ...(strength ? { options: { strength } } : {}) });
  equal(marked.bytes, readFileSync(out), `${name}: marked file`);
  const changed = Object.keys(marked.resources).sort();
  changed.forEach((uri, i) => equal(marked.resources[uri], readFileSync(`${out}.${i}`), `${name}: ${uri}`));
  assertSameReport(marked.report, nativeReport, `${name}: embed report`);

  const read = async (file, bytes, given, what) => {
    const there = Object.keys(given).map((uri) => `${uri}=${out}.${changed.indexOf(uri)}`);
    const expected = await runNative('extract', file, join(folder, 'key.json'), ...there);
    const result = await extract(bytes, { key, resources: given });
    assert.deepEqual([...(result.image?.bits ?? [])], expected.bits, `${what}: bits`);
    assert.deepEqual([...(result.image?.erased ?? [])], expected.erased, `${what}: erased`);
    assert.deepEqual([...(result.image?.confidence ?? [])], expected.confidence.map(Math.fround), `${what}: confidence`);
    assert.deepEqual([...result.evidence], expected.evidence.map(Math.fround), `${what}: evidence`);
    assert.equal(result.text, expected.text, `${what}: text`);
    assert.equal(result.id === null ? null : BigInt(`0x${result.id}`).toString(), expected.id, `${what}: id`);
    assert.equal(result.verdict, expected.verdict, what);
    assert.equal(result.falsePositive, expected.falsePositive, what);
    assert.deepEqual(result.report, expected.report, `${what}: extract report`);
    return result;
  };
  const result = await read(out, marked.bytes, marked.resources, `${name}, marked`);
  if (payload?.id) assert.equal(result.id, payload.id.padStart(16, '0'), `${name}: the ID comes back`);
  else if (payload?.text) assert.equal(result.text, payload.text, `${name}: the text comes back`);
  else assert.deepEqual(result.image.bits, image.bits, `${name}: the image comes back`);
  if (changed.length > 0) return;
  for (const request of attacks) {
    const what = `${name}, ${request.kind}`;
    const { amount = 0, variant = '', iterations = 1, seed = 1 } = request;
    const damagedPath = join(folder, 'damaged.ply');
    await runNative('attack', out, damagedPath, request.kind, amount, variant, iterations, seed);
    const damaged = await attack(marked.bytes, request);
    equal(damaged.bytes, readFileSync(damagedPath), what);
    await read(damagedPath, damaged.bytes, {}, what);
  }
}

const ATTACKS = [
  { kind: 'affine', variant: 'CB' }, { kind: 'reorder', seed: 3 }, { kind: 'crop', amount: 0.5 },
  { kind: 'noise', amount: 1e-5, seed: 4 }, { kind: 'quantize', amount: 16, variant: 'common' },
  { kind: 'quantize', amount: 14, variant: 'per-axis' }, { kind: 'smooth', amount: 1e-3, variant: 'taubin', iterations: 2 },
  { kind: 'smooth', amount: 1e-3, variant: 'laplacian' }, { kind: 'simplify', amount: 0.3, variant: 'meshopt' },
  { kind: 'simplify', amount: 0.2, variant: 'qem' }, { kind: 'deform', amount: 0.5 }, { kind: 'local-noise', amount: 1e-4 },
];

test('generated models are bit-equal', { skip }, async (t) => {
  const folder = temporaryFolder(t);
  for (const [name, vertices, format] of [['sculpture', 9000, 'glb'], ['part', 5000, 'ply'], ['icosphere', 600, 'ply']]) {
    const path = join(folder, `${name}.${format}`);
    await runNative('generate', path, name, vertices, 5);
    equal((await generate({ name, vertices, format, seed: 5 })).bytes, readFileSync(path), name);
  }
});

test('a sculpture is marked, damaged in every way and read alike', { skip }, async (t) => {
  const path = join(temporaryFolder(t), 'sculpture.ply');
  writeFileSync(path, (await generate({ name: 'sculpture', vertices: 9000 })).bytes);
  await compare(t, path, { attacks: ATTACKS });
});

test('a machined part, full of coplanar faces, is marked and read alike', { skip }, async (t) => {
  const path = join(temporaryFolder(t), 'part.glb');
  writeFileSync(path, (await generate({ name: 'part', vertices: 8000, format: 'glb' })).bytes);
  await compare(t, path, { L: 3, attacks: ATTACKS.slice(0, 3) });
});

test('real models are marked and read alike', { skip }, async (t) => {
  for (const { path } of realModels(t, ['bunny.ply', 'fandisk.glb', 'rocker-arm.ply', 'beast-quads.ply', 'Duck.glb', 'SheenCloth.glb', 'Fox/Fox.gltf'])) {
    const small = /Duck|Fox/.test(path);
    await compare(t, path, { L: /fandisk/.test(path) ? 3 : 2, size: small ? 8 : 24, attacks: [{ kind: 'affine', variant: 'CB' }, { kind: 'crop', amount: 0.5 }] });
  }
});

test('marks of scheme robust are written, damaged in every way and read alike', { skip }, async (t) => {
  const path = join(temporaryFolder(t), 'sculpture.ply');
  writeFileSync(path, (await generate({ name: 'sculpture', vertices: 9000 })).bytes);
  const scheme = 'robust';
  await compare(t, path, { scheme, payload: { id: 'c0ffee' }, attacks: [...ATTACKS, { kind: 'quantize', amount: 9, variant: 'common' }] });
  await compare(t, path, { scheme, payload: { text: 'a text with a body' }, attacks: ATTACKS.slice(0, 3) });
  await compare(t, path, { scheme, size: 16, attacks: [...ATTACKS.slice(0, 5), { kind: 'noise', amount: 1e-3, seed: 4 }] });
});

test('a machined part and a regular mesh are marked alike by scheme robust', { skip }, async (t) => {
  const folder = temporaryFolder(t);
  const models = [['part', 8000], ['icosphere', 6000], ['part', 9000, 'strong'], ['icosphere', 40962, 'strong']];
  for (const [name, vertices, strength] of models) {
    const path = join(folder, `${name}.ply`);
    writeFileSync(path, (await generate({ name, vertices })).bytes);
    await compare(t, path, { scheme: 'robust', payload: { id: '1' }, strength, attacks: ATTACKS.slice(0, 3) });
  }
});

test('real models are marked and read alike by scheme robust', { skip }, async (t) => {
  for (const { path } of realModels(t, ['bunny.ply', 'fandisk.glb', 'beast-quads.ply', 'Duck.glb'])) {
    await compare(t, path, { scheme: 'robust', payload: { id: 'fedcba9876543210' },
      attacks: [{ kind: 'affine', variant: 'CB' }, { kind: 'quantize', amount: 12, variant: 'common' }, { kind: 'simplify', amount: 0.3, variant: 'meshopt' }] });
  }
});
