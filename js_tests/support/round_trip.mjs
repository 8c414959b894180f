// SPDX-License-Identifier: MIT
// A tool between two of our calls, in both directions: our output goes into the tool and is read again afterwards; the
// tool's output is marked by us, goes into the tool again and is read again.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { embed, extract, inspect } from 'quadmark';
import { realModels } from './files.mjs';
import { openGltf, positionAccessors } from './gltf.mjs';
import { readDocument, validatorErrors } from './gltf_readers.mjs';
import { fixedKey, logo } from './marks.mjs';
import { webScene } from './scenes.mjs';
import { runTool } from './tools.mjs';

const COMPRESSIONS = ['KHR_draco_mesh_compression', 'EXT_meshopt_compression', 'KHR_meshopt_compression'];

async function assertReadable(model, key, what) {
  const { vertices } = await inspect(model);
  assert.ok(vertices > 0, what);
  const read = await extract(model, { key });
  assert.ok(['match', 'none', 'inconclusive'].includes(read.verdict), what);
  return read;
}

/** Number format of each accessor that holds positions, which a mark must not change. */
function positionFormats(model) {
  const { json } = openGltf(model);
  return [...positionAccessors(json)].map((index) => {
    const { componentType, normalized = false, count } = json.accessors[index];
    return { componentType, normalized, count };
  });
}

const stillCompressed = ({ extensionsUsed = [] }) => COMPRESSIONS.filter((name) => extensionsUsed.includes(name));

/** Whether glTF-Transform reads a model; it knows no KHR_meshopt_compression, which gltfpack -cz writes. */
const othersRead = (model) => readDocument(model).then(() => true, () => false);

/**
 * Validator errors of what a tool wrote, those included that show only when its data is decoded, such as skin weights
 * that Draco's grid has left without a sum of 1.
 */
async function errorsOf(made) {
  const seen = await validatorErrors(made);
  if (stillCompressed(openGltf(made).json).length === 0 || !await othersRead(made)) return seen;
  return Math.max(seen, await validatorErrors(await runTool('gltf-transform copy', made)));
}

/** Marks what a tool wrote: on its grid, decoded with a warning, or refused with the numbers. Returns the mark or null. */
async function assertEmbeds(t, made, key, image, what) {
  let marked;
  try {
    marked = await embed(made, { key, image });
  } catch (error) {
    assert.equal(error.code, 'capacity', `${what}: ${error.message}`);
    assert.ok(error.message.match(/\d+/g)?.length >= 2, `${what}: a refusal names what is there and what is needed: ${error.message}`);
    t.diagnostic(`${what}: ${error.message}`);
    return null;
  }
  assert.deepEqual(positionFormats(marked.bytes), positionFormats(made), `${what}: position formats`);
  for (const name of stillCompressed(openGltf(made).json)) {
    assert.ok(marked.report.warnings.some((text) => text.includes(name)), `${what}: says that ${name} was decoded: ${marked.report.warnings}`);
  }
  const errors = await errorsOf(made);
  assert.ok(await validatorErrors(marked.bytes) <= errors, `${what}: more than ${errors} validator errors`);
  assert.ok(await othersRead(marked.bytes) || !await othersRead(made), `${what}: glTF-Transform does not read it any more`);
  const read = await extract(marked.bytes, { key });
  assert.equal(read.verdict, 'match', what);
  assert.deepEqual(read.image.bits, image.bits, what);
  return marked;
}

/**
 * @param tool   { name, run: GLB -> promise of a GLB }
 * @param model  a GLB
 * @param survives  whether the tool keeps positions well enough for the mark to be read again, bit by bit
 */
export async function assertRoundTrip(t, tool, model, { survives = false } = {}) {
  const image = logo(24), small = logo(8);
  const key = await fixedKey(24), smallKey = await fixedKey(8);

  const marked = await embed(model, { key, image });
  const read = await assertReadable(await tool.run(marked.bytes), key, `${tool.name} of ours`);
  if (survives) {
    assert.equal(read.verdict, 'match', `${tool.name}: the mark survives`);
    assert.deepEqual(read.image.bits, image.bits, tool.name);
  }

  const made = await tool.run(model);
  await assertReadable(made, smallKey, `ours of ${tool.name}`);
  const again = await assertEmbeds(t, made, smallKey, small, `ours of ${tool.name}`);
  if (again) await assertReadable(await tool.run(again.bytes), smallKey, `${tool.name} of ours of ${tool.name}`);
}

/**
 * A test for each command line, with a generated scene and with the GLBs among the real models that are there.
 * @param rows  [{ line, survives }] as for runTool() and assertRoundTrip()
 */
export async function testRoundTrips(rows, names) {
  const scene = await webScene();
  for (const { line, survives } of rows) {
    const tool = { name: line, run: (model) => runTool(line, model) };
    test(line, async (t) => {
      await assertRoundTrip(t, tool, scene, { survives });
      for (const { path } of realModels(t, names)) await assertRoundTrip(t, tool, readFileSync(path), { survives });
    });
  }
}
