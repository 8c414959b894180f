// SPDX-License-Identifier: MIT
// What the evaluation says of tools: every command line that an ordinary machine can run does what its row says.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { getBounds } from '@gltf-transform/core';
import { generate } from 'quadmark/lab';
import { recordedContext } from '../bench/evaluation/context.mjs';
import { workerFile } from '../bench/evaluation/paths.mjs';
import { Rows } from '../bench/evaluation/rows.mjs';
import { TOOL_LINES } from '../bench/evaluation/tools/lines.mjs';
import { describeModel } from '../bench/evaluation/tools/made.mjs';
import { besideLarge } from '../bench/evaluation/tools/scene.mjs';
import { lossesByTool, shortTable } from '../bench/evaluation/tools/tables.mjs';
import { notHere, openTools } from '../bench/evaluation/tools/through.mjs';
import { attackOf, runTrial } from '../bench/evaluation/tools/trial.mjs';
import { repository, temporaryFolder } from './support/files.mjs';
import { readDocument } from './support/gltf_readers.mjs';

const noWorker = existsSync(workerFile) ? false : `${workerFile} is not built`;
const TRIAL = { scheme: 'robust', settings: 'standard', payload: 'id', model: 'sculpture:6000:1', seed: 1 };
// What no 64-bit mark is asked to survive on so small a model.
const HARD = ['gltfpack -si 0.5', ...TOOL_LINES.map(({ line }) => line).filter((line) => /^scene .*optimize$|^scene 1\/100 /.test(line))];

async function rowsOf(t, list, trial = TRIAL) {
  const tools = openTools(), rows = [];
  t.after(() => tools.close());
  await runTrial(trial, list, tools, (row) => rows.push(row));
  return rows;
}

test('the programs of an ordinary setup: each row is true', { skip: noWorker }, async (t) => {
  const here = TOOL_LINES.filter(({ line }) => {
    const reason = /\b(gltf-transform|gltfpack|gltf-pipeline|three)\b/.test(line) ? notHere(line) : 'is for the full evaluation';
    if (reason) t.diagnostic(`${line}: ${reason}`);
    return reason === null;
  });
  assert.ok(here.length >= 26, 'npm ci installs these');
  const half = Math.ceil(here.length / 2);
  const rows = (await Promise.all([here.slice(0, half), here.slice(half)].map((list) => rowsOf(t, list)))).flat();
  assert.deepEqual(rows.map((row) => row.attack), here.map(({ line }) => attackOf(line)), 'a row for each');
  for (const [i, { line, expects = {} }] of here.entries()) {
    const { outcome, note, ber } = rows[i];
    const [, after, before, bits] = /^(\d+) of (\d+) vertices(?:, (\d+) bits)?$/.exec(note) ?? assert.fail(`${line}: ${note}`);
    assert.ok(Number(after) <= Number(before) && Number(after) > 0, `${line}: ${note}`);
    if (expects.bits) assert.equal(Number(bits), expects.bits, `${line}: ${note}`);
    else if (/copy|weld|-noq|three/.test(line)) assert.equal(bits, undefined, `${line} keeps float32: ${note}`);
    if (expects.removes) assert.ok(Number(after) < 0.6 * Number(before), `${line}: ${note}`);
    if (!HARD.includes(line)) assert.deepEqual({ outcome, ber }, { outcome: 'exact', ber: 0 }, line);
    else assert.ok(['exact', 'match', 'lost'].includes(outcome), `${line}: ${outcome}`);
  }
});

test('a tool that does something else than its line says has failed', { skip: noWorker }, async (t) => {
  const [row] = await rowsOf(t, [{ line: 'gltf-transform copy', expects: { bits: 14 } }]);
  assert.equal(row.outcome, 'failed');
  assert.equal(row.note, 'gltf-transform copy: its positions are finer than 14 bits');
  assert.equal(row.ber, undefined);
});

test('a program that is not there gives a row that says so', { skip: noWorker }, async (t) => {
  const { PATH } = process.env;
  process.env.PATH = '';
  try {
    const [row] = await rowsOf(t, [{ line: 'draco_encoder -qp 11' }]);
    assert.deepEqual(row, { ...TRIAL, attack: 'tool:draco_encoder -qp 11', outcome: 'failed',
      note: 'not installed: draco_encoder (scripts/setup.sh --evaluation installs it)' });
  } finally {
    process.env.PATH = PATH;
  }
});

test('a mark that was refused is a trial of no tool', { skip: noWorker }, async (t) => {
  const rows = await rowsOf(t, [{ line: 'gltf-transform copy' }], { ...TRIAL, model: 'icosphere:162' });
  assert.equal(rows[0].outcome, 'refused');
  assert.ok(rows[0].note.length > 10);
});

test('a model beside a large one keeps its coordinates, in a scene as much larger as is said', async () => {
  const glb = Buffer.from((await generate({ name: 'part', vertices: 1500, format: 'glb' })).bytes);
  const scene = await besideLarge(glb, 20);
  const [alone, both] = await Promise.all([glb, scene].map(async (bytes) => (await readDocument(bytes)).getRoot()));
  const side = (root) => {
    const { min, max } = getBounds(root.listScenes()[0]);
    return Math.max(...max.map((value, axis) => value - min[axis]));
  };
  assert.ok(Math.abs(side(both) / side(alone) - 20) < 1e-4, `${side(both) / side(alone)}`);
  const positions = (root) => root.listMeshes()[0].listPrimitives()[0].getAttribute('POSITION').getArray();
  assert.deepEqual(positions(both), positions(alone));
  const described = await describeModel(scene);
  assert.equal(described.vertices, (await describeModel(glb)).vertices + (await describeModel(
    Buffer.from((await generate({ name: 'sculpture', vertices: 3000, seed: 77, format: 'glb' })).bytes))).vertices);
});

test('tables count what came back, and say what could not be run', (t) => {
  const rows = new Rows(join(temporaryFolder(t), 'readings.csv'));
  const add = (scheme, settings, line, outcomes, note) => outcomes.forEach((outcome, i) =>
    rows.add({ scheme, settings, payload: 'id', model: 'a.glb', seed: i + 1, attack: attackOf(line), outcome, ber: 0.5, note }));
  add('robust', 'standard', 'gltfpack', ['exact', 'exact', 'match', 'lost'], '9 of 10 vertices, 14 bits');
  add('robust', 'strong', 'gltfpack', ['exact', 'refused']);
  add('paper', 'L=2', 'gltfpack', ['lost', 'lost']);
  add('hopeless', 'x', 'gltfpack', ['lost', 'lost']);
  add('better', 'x', 'gltfpack', ['exact', 'exact', 'exact', 'exact']);
  add('robust', 'standard', 'blender glb draco', ['failed'], 'no library');
  const table = shortTable({ rows, machine: { date: '2001-02-03', tools: { gltfpack: '1.3' } } });
  assert.ok(table.includes('| `gltfpack` | gltfpack 1.3 | 2 + 1 of 4 | 1 of 1 | 0 of 2 | `better` 4 of 4 |'), table);
  assert.ok(table.includes('| Blender, GLB in, GLB with Draco out | blender (version unknown) | not run: no library |'), table);
  assert.ok(table.includes('Measured 2001-02-03.'), table);
  assert.deepEqual(lossesByTool({ rows }), [{ where: 'tools: `gltfpack`', ours: '`robust` 2 + 1 of 4', theirs: '`better` 4 of 4' }]);
});

test('rows can be forgotten, to be measured again', (t) => {
  const path = join(temporaryFolder(t), 'readings.csv'), rows = new Rows(path);
  const row = { ...TRIAL, attack: 'tool:gltfjsx -T', outcome: 'failed', note: 'not installed: gltfjsx' };
  rows.add(row);
  rows.add({ ...row, attack: 'tool:gltfpack', outcome: 'exact' });
  rows.forget(({ outcome }) => outcome === 'failed');
  assert.ok(!rows.has(row));
  assert.equal(new Rows(path).select().length, 1);
  rows.add({ ...row, outcome: 'lost' });
  assert.equal(new Rows(path).select({ outcome: 'lost' }).length, 1);
  const { scheme, model } = row;
  assert.deepEqual(rows.select({ scheme, model }).map(({ outcome }) => outcome), ['exact', 'lost'], 'what is forgotten is not found either');
});

test('the table in README.md is the one of the committed rows', (t) => {
  const folder = join(repository, 'bench/results');
  if (!existsSync(join(folder, 'readings.csv'))) return t.diagnostic('no results are committed');
  const readme = readFileSync(join(repository, 'README.md'), 'utf8');
  const [, table] = /<!-- tools -->\n([^]*?)\n<!-- \/tools -->/.exec(readme);
  assert.equal(table, shortTable(recordedContext(folder, { quick: false })));
});
