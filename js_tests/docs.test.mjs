// SPDX-License-Identifier: MIT
// The READMEs are true: their JavaScript and quadmark command blocks are run, in order, in a folder with the files they
// name: model.glb, model.ply and logo.png; C++ is compiled. A block under an HTML comment `<!-- not run: reason -->` is left out.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import { delimiter, join } from 'node:path';
import { test } from 'node:test';
import { cliFile, repository, run, temporaryFolder } from './support/files.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';

function blocksOf(file) {
  const text = readFileSync(file, 'utf8');
  return [...text.matchAll(/(<!--[^>]*not run[^>]*-->\s*)?^```(\w+)\n([\s\S]*?)^```$/gm)]
    .filter(([, skipped]) => skipped === undefined)
    .map(([, , language, code]) => ({ language, code }));
}

async function workspace(t) {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, 'model.glb'), await sculpture('glb', 20000));
  writeFileSync(join(folder, 'model.ply'), await sculpture('ply', 20000));
  writeFileSync(join(folder, 'logo.png'), logoPng(logo()));
  writeFileSync(join(folder, 'package.json'), '{ "type": "module" }');
  mkdirSync(join(folder, 'node_modules'));
  symlinkSync(join(repository, 'node'), join(folder, 'node_modules/quadmark'));
  symlinkSync(join(repository, 'node_modules/@gltf-transform'), join(folder, 'node_modules/@gltf-transform'));
  mkdirSync(join(folder, 'bin'));
  symlinkSync(cliFile, join(folder, 'bin/quadmark'));
  return folder;
}

for (const [name, expected] of [['node/README.md', 3], ['README.md', 3], ['server/README.md', 1]]) {
  const file = join(repository, name);
  test(`the blocks of ${name} run`, { skip: existsSync(file) ? false : `${name} does not exist` }, async (t) => {
    const folder = await workspace(t);
    const env = { PATH: `${join(folder, 'bin')}${delimiter}${process.env.PATH}` };
    let runs = 0;
    for (const { language, code } of blocksOf(file)) {
      if (language === 'js' || language === 'mjs') {
        writeFileSync(join(folder, 'block.mjs'), code);
        const { status, stderr } = await run(process.execPath, ['block.mjs'], { cwd: folder, env });
        assert.equal(status, 0, `${code}\n${stderr}`);
        ++runs;
      } else if (language === 'sh' && /^\s*(npx )?quadmark /m.test(code)) {
        const script = `set -e\n${code.replace(/\bnpx quadmark\b/g, 'quadmark')}`;
        const { status, stderr } = await run('bash', ['-c', script], { cwd: folder, env });
        assert.equal(status, 0, `${code}\n${stderr}`);
        ++runs;
      } else if (language === 'cpp') {
        writeFileSync(join(folder, 'block.cpp'), code);
        const flags = ['-std=c++20', '-Wall', '-Wextra', '-Werror', '-fsyntax-only', '-I', join(repository, 'core/include')];
        const { status, stderr } = await run('g++', [...flags, 'block.cpp'], { cwd: folder });
        assert.equal(status, 0, `${code}\n${stderr}`);
        ++runs;
      }
    }
    assert.ok(runs >= expected, `${runs} blocks`);
  });
}
