// SPDX-License-Identifier: MIT
// The tools of web builds, run as their users run them: bytes of a model in, bytes of what the tool made of it out.
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { repository, run } from './files.mjs';
import { isGlb } from './gltf.mjs';

// Where each program wants the names of its files.
const withFiles = {
  'gltf-transform': ([command, ...options], input, output) => [command, input, output, ...options],
  gltfpack: (options, input, output) => [...options, '-i', input, '-o', output],
  'gltf-pipeline': (options, input, output) => [...options, '-i', input, '-o', output],
};

/**
 * Runs a command line such as "gltf-transform draco" or "gltfpack -cc" (no file names in it) on a GLB or glTF.
 *
 * @param resources  { uri: bytes } of the files that a .gltf refers to
 * @return the GLB that the tool wrote
 * @throws Error with the tool's own words when it fails or complains of an error
 */
export async function runTool(commandLine, model, resources = {}) {
  const [program, ...words] = commandLine.split(' ');
  const folder = mkdtempSync(join(tmpdir(), 'quadmark-tool-'));
  try {
    const input = join(folder, isGlb(model) ? 'in.glb' : 'in.gltf');
    const output = join(folder, 'out.glb');
    writeFileSync(input, model);
    for (const [uri, bytes] of Object.entries(resources)) {
      const path = join(folder, decodeURIComponent(uri));
      mkdirSync(dirname(path), { recursive: true });
      writeFileSync(path, bytes);
    }
    const args = withFiles[program](words, input, output);
    const { status, stdout, stderr } = await run(process.execPath, [join(repository, 'node_modules/.bin', program), ...args]);
    const said = `${stdout}${stderr}`.trim();
    if (status !== 0 || /\berror:/i.test(said)) throw new Error(`${commandLine}: exit status ${status}\n${said.slice(-2000)}`);
    return readFileSync(output);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}
