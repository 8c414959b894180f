// SPDX-License-Identifier: MIT
// The tools of web builds, run as their users run them: bytes of a model in, bytes of what the tool made of it out.
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { delimiter, dirname, join } from 'node:path';
import { attack } from 'quadmark/lab';
import { repository, run } from './files.mjs';
import { isGlb } from './gltf.mjs';

const SETUP = 'scripts/setup.sh', SETUP_EVALUATION = 'scripts/setup.sh --evaluation';
const TIMEOUT = 10 * 60 * 1000;  // a tool that waits for something that never comes must not hold up a long run

const inNode = (folder) => (name) => {
  const path = join(repository, folder, 'node_modules/.bin', name);
  return existsSync(path) ? [process.execPath, path] : null;
};
const onPath = (name) => {
  const path = (process.env.PATH ?? '').split(delimiter).map((folder) => join(folder, name)).find((file) => existsSync(file));
  return path ? [path] : null;
};
const ours = { find: inNode('.'), setup: SETUP }, evaluation = { find: inNode('bench/evaluation/programs'), setup: SETUP_EVALUATION };
const debian = { find: onPath, setup: SETUP_EVALUATION };

const lastWord = (text) => text.trim().split(/\s+/).at(-1);
const blenderScript = join(repository, 'js_tests/support/blender.py');

// find, setup: where it is, and what installs it. versionOf: how it is asked for its version, and the version in its answer.
// calls: the arguments of each call, from the words of a command line and the names of input and output in the folder
// where it runs. input, output: their extensions, "glb" where nothing is said, which may depend on the words.
const programs = {
  'gltf-transform': {
    ...ours, versionOf: [['--version'], lastWord],
    calls: ([command, ...options], input, output) => [[command, input, output, ...options]],
  },
  gltfpack: {
    ...ours, versionOf: [['-v'], lastWord],
    calls: (options, input, output) => [[...options, '-i', input, '-o', output]],
  },
  'gltf-pipeline': {
    ...ours, versionOf: [['--version'], lastWord],
    calls: (options, input, output) => [[...options, '-i', input, '-o', output]],
  },
  gltfjsx: {  // names its output itself
    ...evaluation, versionOf: [['--version'], lastWord],
    calls: (options, input) => [[input, ...options]],
    output: () => 'in-transformed.glb',
  },
  draco_encoder: {  // does not tell its version, and knows no glTF
    ...debian, versionOf: [null, 'draco'],
    calls: (options, input, output) => [[...options, '-i', input, '-o', output]],
    input: 'ply',
    output: () => 'out.drc',
  },
  draco_transcoder: {
    ...debian, versionOf: [null, 'draco'],
    calls: (options, input, output) => [[...options, '-i', input, '-o', output]],
  },
  assimp: {  // "assimp obj": to a file of that kind and, where it is none that we read, from there to a GLB
    ...debian, versionOf: [['version'], (text) => text.match(/Version (\S+)/)[1]],
    calls: ([kind], input, output) => (kind === 'ply'
      ? [['export', input, output, '-fply']]
      : [['export', input, `out.${kind}`], ['export', `out.${kind}`, output, '-fglb2']]),
    output: ([kind]) => (kind === 'ply' ? 'out.ply' : 'out.glb'),
  },
  blender: {  // "blender obj": imports, exports to a file of that kind and, where it is none that we read, on to a GLB
    ...debian, versionOf: [['--version'], (text) => text.match(/Blender (\S+)/)[1]],
    calls: (words, input, output) =>
      [['-b', '--factory-startup', '--python-exit-code', '3', '--python', blenderScript, '--', input, output, ...words]],
    output: ([kind]) => (kind === 'ply' ? 'out.ply' : 'out.glb'),
    complains: /^quadmark: (.*)$/m,  // what our script says; Blender itself reports errors that concern nobody
  },
};

/** Why a command line cannot be run here, or null. */
export function missing(commandLine) {
  const [name] = commandLine.split(' ');
  return programs[name].find(name) ? null : `not installed: ${name} (${programs[name].setup} installs it)`;
}

/** The version that a command line's program, which is installed, says it has. */
export async function toolVersion(commandLine) {
  const [name] = commandLine.split(' '), { find, versionOf: [ask, answer] } = programs[name];
  if (ask === null) {
    const { status, stdout } = await run('dpkg-query', ['-W', '-f', '${Version}', answer]);
    return status === 0 ? stdout.toString().trim() : 'of unknown version';
  }
  const [file, ...first] = find(name);
  return answer((await run(file, [...first, ...ask])).stdout.toString());
}

const asPly = async (model, resources) => (await attack(model, { kind: 'noise', amount: 0, format: 'ply', resources })).bytes;

/**
 * Runs a command line such as "gltf-transform draco" or "gltfpack -cc" (no file names in it) on a GLB or glTF.
 *
 * @param resources  { uri: bytes } of the files that a .gltf refers to
 * @return the GLB, PLY or .drc that the tool wrote
 * @throws Error with the tool's own words when it fails or complains of an error, or is not installed
 */
export async function runTool(commandLine, model, resources = {}) {
  const reason = missing(commandLine);
  if (reason) throw new Error(reason);
  const [name, ...words] = commandLine.split(' ');
  const { find, calls, input: wanted = 'glb', output: outputOf = () => 'out.glb', complains = /\berror:.*/i } = programs[name];
  const folder = mkdtempSync(join(tmpdir(), 'quadmark-tool-'));
  try {
    const input = wanted === 'ply' ? 'in.ply' : isGlb(model) ? 'in.glb' : 'in.gltf', output = outputOf(words);
    writeFileSync(join(folder, input), wanted === 'ply' ? await asPly(model, resources) : model);
    for (const [uri, bytes] of Object.entries(resources)) {
      const path = join(folder, decodeURIComponent(uri));
      mkdirSync(dirname(path), { recursive: true });
      writeFileSync(path, bytes);
    }
    const [file, ...first] = find(name);
    for (const args of calls(words, input, output)) {
      const { status, stdout, stderr } = await run(file, [...first, ...args], { cwd: folder, timeout: TIMEOUT });
      const said = `${stdout}${stderr}`.trim(), complaint = said.match(complains);
      if (status !== 0 || complaint) {
        throw new Error(complaint?.[1] ?? `${commandLine}: exit status ${status ?? 'none: it was stopped'}\n${said.slice(-2000)}`);
      }
    }
    if (!existsSync(join(folder, output))) throw new Error(`${commandLine}: wrote no ${output}`);
    return readFileSync(join(folder, output));
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}
