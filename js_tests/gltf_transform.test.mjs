// SPDX-License-Identifier: MIT
// quadmark/gltf-transform: as a transform of a script, and as a command of glTF-Transform's own command line.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { Document, Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS, EXTMeshoptCompression } from '@gltf-transform/extensions';
import { createKey, embed, extract } from 'quadmark';
import { quadmark, QUADMARK_DEFAULTS } from 'quadmark/gltf-transform';
import { allRealModels, readImageFiles, readModelFiles, repository, run, temporaryFolder } from './support/files.mjs';
import { readDocument, validatorErrors } from './support/gltf_readers.mjs';
import { fixedRobustKey } from './support/marks.mjs';
import { webScene } from './support/scenes.mjs';
import { runTool } from './support/tools.mjs';

const key = await fixedRobustKey();
const id = 'c0ffee0000000001';
const scene = await webScene(6000);
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
const positionsOf = (document) => new Set(document.getRoot().listMeshes().flatMap((mesh) => mesh.listPrimitives()).map((primitive) => primitive.getAttribute('POSITION')));
const fails = (work, code, message) => assert.rejects(work, (error) => error.name === 'QuadmarkError' && error.code === code && message.test(error.message));

test('a document is marked, and what is written from it reads back', async () => {
  const document = await readDocument(scene);
  let report;
  const transform = quadmark({ key, id, onReport: (facts) => { report = facts; } });
  assert.equal(transform.name, 'quadmark');
  await document.transform(transform);
  assert.equal(report.payload, 'id');
  const glb = await io.writeBinary(document);
  assert.equal(await validatorErrors(glb), 0);
  const read = await extract(glb, { key });
  assert.deepEqual([read.verdict, read.id], ['match', id]);
});

test('the positions are those that marking the written file gives', async () => {
  const document = await readDocument(scene);
  await document.transform(quadmark({ key, id, strength: 'strong', salt: 'gallery' }));
  const direct = await readDocument((await embed(scene, { key, id, options: { strength: 'strong', salt: 'gallery' } })).bytes);
  const [here, there] = [document, direct].map((one) => [...positionsOf(one)].map((accessor) => accessor.getArray()));
  assert.deepEqual(here, there);
});

test('defaults are those it says', async () => {
  const [implicit, explicit] = await Promise.all([{}, QUADMARK_DEFAULTS].map(async (options) => {
    const document = await readDocument(scene);
    await document.transform(quadmark({ key, id, ...options }));
    return io.writeBinary(document);
  }));
  assert.deepEqual(implicit, explicit);
});

test('nothing but the values of positions changes', async () => {
  const document = await readDocument(scene);
  const root = document.getRoot();
  const second = document.createBuffer('second');
  root.listAccessors().forEach((accessor, i) => { if (i % 2 === 1) accessor.setBuffer(second); });
  root.setExtras({ by: 'someone' });
  const positions = positionsOf(document);
  const facts = () => ({
    accessors: root.listAccessors(),
    arrays: root.listAccessors().map((accessor) => (positions.has(accessor) ? null : accessor.getArray())),
    shapes: root.listAccessors().map((accessor) => [accessor.getType(), accessor.getComponentType(), accessor.getCount(), accessor.getNormalized(), accessor.getBuffer()]),
    primitives: root.listMeshes().flatMap((mesh) => mesh.listPrimitives()).map((primitive) => [primitive.getIndices(), ...primitive.listAttributes()]),
    rest: [root.listBuffers(), root.listTextures(), root.listMaterials(), root.listNodes(), root.listMeshes(), root.listScenes(), root.listExtensionsUsed(), root.getExtras()],
  });
  const before = facts();
  const contents = before.arrays.map((array) => array?.slice());
  const old = [...positions].map((accessor) => accessor.getArray());
  const oldContents = old.map((array) => array.slice());
  await document.transform(quadmark({ key, id }));
  const after = facts();
  const same = (one, two) => (Array.isArray(one) ? one.length === two.length && one.every((item, i) => same(item, two[i])) : one === two);
  for (const name of Object.keys(before)) assert.ok(same(before[name], after[name]), `${name} are the very same`);
  after.arrays.forEach((array, i) => assert.deepEqual(array ?? undefined, contents[i]));
  assert.deepEqual(old, oldContents, 'arrays that others may hold stay as they were');
  assert.ok([...positions].some((accessor, i) => accessor.getArray().some((value, k) => value !== oldContents[i][k])));
});

test('quantized positions stay on their grid, in their type', async () => {
  const packed = await runTool('gltf-transform quantize --quantize-position 16', scene);
  const document = await readDocument(packed);
  const types = () => [...positionsOf(document)].map((accessor) => [accessor.getArray().constructor.name, accessor.getNormalized(), accessor.getCount()]);
  const before = types();
  assert.ok(before.some(([type]) => type === 'Int16Array' || type === 'Uint16Array'), JSON.stringify(before));
  await document.transform(quadmark({ key, id }));
  assert.deepEqual(types(), before);
  assert.equal((await extract(await io.writeBinary(document), { key })).id, id);
});

test('a compression extension that comes afterwards is warned of, or refused where it removes the mark', async () => {
  const document = await readDocument(scene);
  document.createExtension(EXTMeshoptCompression).setRequired(true);
  const warnings = [];
  document.setLogger(Object.assign(new Logger(Logger.Verbosity.SILENT), { warn: (text) => warnings.push(text) }));
  await document.transform(quadmark({ key, id }));
  assert.match(warnings.join(), /EXT_meshopt_compression will quantize/);
  await fails(document.transform(quadmark({ key: await createKey({ id: true }), id })), 'unsupported_file', /EXT_meshopt_compression would remove/);
});

test('what it cannot handle is refused, and the document stays as it was', async () => {
  const document = await readDocument(scene);
  const [mesh] = document.getRoot().listMeshes();
  const [primitive] = mesh.listPrimitives();
  const positions = primitive.getAttribute('POSITION');
  const before = positions.getArray();
  primitive.setAttribute('_REST', positions);
  await fails(document.transform(quadmark({ key, id })), 'unsupported_file', /mesh 0 "icosphere", primitive 0: POSITION is read by another property too/);
  primitive.setAttribute('_REST', null);
  await fails(document.transform(quadmark({ key: await createKey({ id: true, scrambleOrder: true }), id })), 'bad_key', /scrambleOrder/);
  await fails(document.transform(quadmark({ key, id, maxError: 7 })), 'bad_option', /maxError/i);
  positions.setArray(new Uint32Array(before.length));
  await fails(document.transform(quadmark({ key, id })), 'unsupported_file', /component type 5125/);
  positions.setArray(before);
  await fails(new Document().transform(quadmark({ key, id })), 'bad_mesh', /no triangles/);
  assert.equal(positions.getArray(), before);
  assert.deepEqual(await io.writeBinary(document), await io.writeBinary(await readDocument(scene)));
  const options = (value, message) => assert.throws(() => quadmark(value), (error) => error.code === 'bad_option' && message.test(error.message));
  options({ id }, /no key/);
  options({ key }, /exactly one of image, id and text/);
  options({ key, id, strenght: 'strong' }, /unknown member "strenght"/);
});

test('gltf-transform --config adds the command mark, wherever --config stands', async (t) => {
  const folder = temporaryFolder(t);
  mkdirSync(join(folder, 'node_modules'));
  symlinkSync(join(repository, 'node'), join(folder, 'node_modules/quadmark'));
  writeFileSync(join(folder, 'quadmark.config.mjs'), 'export { default } from \'quadmark/gltf-transform/config\';\n');
  writeFileSync(join(folder, 'key.json'), JSON.stringify(key));
  writeFileSync(join(folder, 'in.glb'), scene);
  const tool = (args) => run(process.execPath, [join(repository, 'node_modules/.bin/gltf-transform'), ...args], { cwd: folder });
  const mark = ['mark', 'in.glb', 'out.glb', '--key', 'key.json', '--id', '1e5', '--strength', 'strong'];
  for (const args of [['--config', 'quadmark.config.mjs', ...mark], [...mark, '--config', 'quadmark.config.mjs']]) {
    const { status, stdout, stderr } = await tool(args);
    assert.equal(status, 0, `${stdout}${stderr}`);
    assert.equal((await extract(readFileSync(join(folder, 'out.glb')), { key })).id, '00000000000001e5');
  }
  const refused = await tool(['--config', 'quadmark.config.mjs', 'mark', 'in.glb', 'none.glb', '--key', 'absent.json', '--id', '1']);
  assert.equal(refused.status, 1);
  assert.match(`${refused.stdout}${refused.stderr}`, /cannot read the key absent\.json/);
  assert.equal(existsSync(join(folder, 'none.glb')), false);
});

test('real models: what the transform marks reads back and loads, or is refused with a code', { timeout: 300000 }, async (t) => {
  let marked = 0, refused = 0;
  for (const { name, path } of allRealModels(t).filter((model) => /\.gl(b|tf)$/.test(model.name))) {
    const { model, resources } = await readModelFiles(path);
    const document = await readDocument(model, { ...resources, ...readImageFiles(path) });
    for (const extension of document.getRoot().listExtensionsUsed()) if (/draco|meshopt/.test(extension.extensionName)) extension.dispose();
    try {
      await document.transform(quadmark({ key, id }));
    } catch (error) {
      assert.match(error.code, /^(capacity|bad_mesh)$/, `${name}: ${error.stack}`);
      ++refused;
      continue;
    }
    const glb = await io.writeBinary(document);
    assert.equal((await extract(glb, { key })).id, id, name);
    ++marked;
  }
  t.diagnostic(`${marked} real models marked, ${refused} refused for their size`);
});
