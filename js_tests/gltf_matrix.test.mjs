// SPDX-License-Identifier: MIT
// The files of the native property test (native_tests/io_gltf_matrix.h), looked at by the Khronos validator: marking
// never adds an error. Written by the native tests; where these are not built, says so.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey, embed, extract } from 'quadmark';
import { repository, run, temporaryFolder } from './support/files.mjs';
import { validatorErrors } from './support/gltf_readers.mjs';

const writer = process.env.QUADMARK_NATIVE_TESTS ?? join(repository, 'build/native/native_tests/quadmark_tests');
const id = '0123456789ABCDEF';

test('the validator finds no more errors after marking any file of the matrix', async (t) => {
  if (!existsSync(writer)) {
    t.diagnostic(`${writer} is not built: this was not tested`);
    return;
  }
  const folder = temporaryFolder(t);
  const { status, stdout } = await run(writer, ['--gtest_filter=GltfMatrix.IsWrittenForOthersWhereAsked'],
    { env: { QUADMARK_MATRIX_FOLDER: folder } });
  assert.equal(status, 0, stdout.toString());
  const names = readdirSync(folder), models = names.filter((name) => name.endsWith('.model'));
  assert.ok(models.length >= 300, `${models.length} files`);
  const key = await createKey({ id: true });
  let marked = 0, refused = 0;
  for (const name of models) {
    const number = name.slice(0, -'.model'.length);
    const what = `${number}: ${readFileSync(join(folder, `${number}.txt`), 'utf8')}`;
    const model = readFileSync(join(folder, name));
    const parts = names.filter((other) => other.startsWith(`${number}.part `));
    const resources = Object.fromEntries(parts.map((part) => [part.slice(number.length + 1), readFileSync(join(folder, part))]));
    const before = await validatorErrors(model, resources);
    let result;
    try {
      result = await embed(model, { key, id, resources });
    } catch (error) {
      assert.equal(error.code, 'capacity', `${what}: ${error.message}`);  // eight bits are too few
      assert.match(what, /^\d+: u?char/);
      ++refused;
      continue;
    }
    ++marked;
    const now = { ...resources, ...result.resources };
    assert.ok(await validatorErrors(result.bytes, now) <= before, `${what}: more than ${before} errors`);
    assert.equal((await extract(result.bytes, { key, resources: now })).id, id.toLowerCase(), what);
  }
  t.diagnostic(`${marked} marked, ${refused} refused for capacity`);
  assert.ok(marked > refused);
});
