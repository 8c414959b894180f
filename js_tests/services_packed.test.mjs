// SPDX-License-Identifier: MIT
// quadmark-server and quadmark-queue as npm delivers them, beside the packed quadmark.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey } from 'quadmark';
import { repository, run } from './support/files.mjs';
import { sculpture } from './support/marks.mjs';
import { pack } from './support/packed.mjs';

test('the packed endpoint and queue run beside the packed package', { timeout: 180_000 }, async (t) => {
  // Inside the repository, so that what they depend on is found further up, and no network is needed.
  const folder = mkdtempSync(join(repository, 'js_tests/.packed-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  for (const [source, name] of [['node', 'quadmark'], ['server', 'quadmark-server'], ['queue', 'quadmark-queue']]) {
    const { tarball, names } = await pack(join(repository, source), folder);
    if (source !== 'node') {
      for (const file of names) assert.match(file, /^(package\.json|README\.md|LICENSE|src\/[\w/.]+)$/, 'nothing else is packed');
      const { scripts, peerDependencies } = JSON.parse(readFileSync(join(repository, source, 'package.json'), 'utf8'));
      assert.equal(scripts, undefined, 'no install scripts');
      assert.ok(peerDependencies.quadmark);
    }
    const target = join(folder, 'node_modules', name);
    mkdirSync(target, { recursive: true });
    assert.equal((await run('tar', ['-xzf', tarball, '-C', target, '--strip-components=1'])).status, 0);
  }
  const help = await run(process.execPath, [join(folder, 'node_modules/quadmark-queue/src/main.js'), 'help', 'add']);
  assert.equal(help.status, 0, help.stderr);
  assert.match(help.stdout.toString(), /--bucket <dir>/);

  mkdirSync(join(folder, 'keys'));
  writeFileSync(join(folder, 'keys/studio.json'), JSON.stringify(await createKey()));
  const server = spawn(process.execPath, [join(folder, 'node_modules/quadmark/src/cli/main.js'), 'serve', '--json', '--quiet', '--port', '0', '--keys', join(folder, 'keys')]);
  const ended = once(server, 'exit');
  t.after(() => server.kill('SIGKILL'));
  const { url } = JSON.parse(String((await once(server.stdout, 'data'))[0]));
  const answer = await fetch(`${url}/v1/embed?id=1`, {
    method: 'POST', headers: { 'quadmark-key': 'studio', 'content-type': 'model/gltf-binary' }, body: await sculpture('glb', 3000),
  });
  assert.equal(answer.status, 200, answer.ok ? '' : await answer.text());
  server.kill('SIGTERM');
  assert.equal((await ended)[0], 0);
});
