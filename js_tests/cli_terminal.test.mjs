// SPDX-License-Identifier: MIT
// What the command line offers people: help, manual page, completion, colours, progress, and --dry-run.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { attackKinds, generate } from 'quadmark/lab';
import { createProgram } from '../node/src/cli/program.js';
import { cliFile, quadmark, repository, run, temporaryFolder } from './support/files.mjs';

const program = createProgram();
const model = (await generate({ name: 'icosphere', vertices: 3000, format: 'glb' })).bytes;

async function workspace(t) {
  const folder = temporaryFolder(t);
  for (const name of ['a.glb', 'b.glb']) writeFileSync(join(folder, name), model);
  const cli = (args, options) => quadmark(args, { cwd: folder, ...options });
  assert.equal((await cli(['keygen', 'key.json'])).status, 0);
  return { folder, cli };
}

const hasProgram = async (name) => (await run('sh', ['-c', `command -v ${name}`])).status === 0;
const skipWithout = async (name) => ((await hasProgram(name)) ? false : `${name} is not installed`);

test('help says the default of every option', () => {
  for (const command of program.commands) {
    for (const option of command.options) {
      const text = command.createHelp().optionDescription(option);
      assert.match(text, /default|needed/, `${command.name()} ${option.flags}: ${text}`);
    }
  }
});

test('help knows the kinds of attack that there are', async () => {
  const kinds = program.commands.find((command) => command.name() === 'attack').options.find(({ long }) => long === '--kind').argChoices;
  assert.deepEqual(kinds, (await attackKinds()).map(({ kind }) => kind));
});

test('the packaged manual page is the help of this version', async () => {
  const { stdout, status } = await quadmark(['man']);
  assert.equal(status, 0);
  assert.equal(readFileSync(join(repository, 'node/man/quadmark.1'), 'utf8'), stdout.toString(),
    'stale: make it anew by `npm run man --workspace node`');
  for (const command of program.commands) assert.match(stdout.toString(), new RegExp(`^\\.SS ${command.name()}`, 'm'));
});

test('man shows the page without complaint', { skip: await skipWithout('groff') }, async () => {
  const { stdout, stderr } = await run('groff', ['-man', '-Tutf8', '-ww', join(repository, 'node/man/quadmark.1')]);
  assert.equal(stderr, '');
  assert.match(stdout.toString(), /fraction of the bounding-box diagonal/);
});

/** What bash would offer for the words of a command line, the last one being typed. */
async function completed(folder, ...words) {
  const { stdout } = await quadmark(['completion', 'bash']);
  const script = `${stdout}\nCOMP_WORDS=(${words.map((word) => `'${word}'`).join(' ')}); COMP_CWORD=${words.length - 1}
_quadmark; printf '%s\\n' "\${COMPREPLY[@]}"`;
  const result = await run('bash', ['-c', script], { cwd: folder });
  assert.equal(result.stderr, '');
  return result.stdout.toString().split('\n').filter(Boolean);
}

test('bash completes commands, options, values and files', async (t) => {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, 'chair.glb'), '');
  assert.deepEqual(await completed(folder, 'quadmark', 'em'), ['embed']);
  assert.deepEqual(await completed(folder, 'quadmark', 'embed', '--max-'), ['--max-error', '--max-slide']);
  assert.deepEqual(await completed(folder, 'quadmark', 'embed', '--strength', 's'), ['standard', 'strong']);
  assert.deepEqual(await completed(folder, 'quadmark', 'embed', 'ch'), ['chair.glb']);
  assert.deepEqual(await completed(folder, 'quadmark', 'embed', 'chair.glb', '--key', 'c'), ['chair.glb']);
  assert.deepEqual(await completed(folder, 'quadmark', 'completion', ''), ['bash', 'zsh', 'fish']);
});

for (const shell of ['zsh', 'fish']) {
  test(`${shell} takes its script, which names every option`, async (t) => {
    const { stdout } = await quadmark(['completion', shell]);
    for (const command of program.commands) {
      for (const { long } of command.options) assert.ok(stdout.includes(shell === 'fish' ? `-l ${long.slice(2)} ` : long), long);
    }
    if (!(await hasProgram(shell))) return t.diagnostic(`${shell} is not installed: its script was not run`);
    const file = join(temporaryFolder(t), 'script');
    writeFileSync(file, stdout);
    const checked = await run(shell, ['-n', file]);
    assert.equal(checked.status, 0, checked.stderr);
  });
}

test('an unknown shell is exit 2', async () => {
  assert.equal((await quadmark(['completion', 'tcsh'])).status, 2);
});

test('--dry-run works everything out and writes nothing', async (t) => {
  const { folder, cli } = await workspace(t);
  const before = readdirSync(folder);
  const dry = await cli(['embed', '*.glb', '--out-dir', 'out', '--id', '1', '--key', 'key.json', '--dry-run', '--json']);
  assert.equal(dry.status, 0, dry.stderr);
  assert.deepEqual(dry.json.map(({ input, dryRun, verified }) => [input, dryRun, verified.unattacked]), [['a.glb', true, true], ['b.glb', true, true]]);
  assert.equal((await cli(['keygen', 'other.json', '--dry-run'])).status, 0);
  assert.match((await cli(['attack', 'a.glb', 'c.ply', '--kind', 'reorder', '--dry-run'])).stdout.toString(), /nothing was written/);
  assert.deepEqual(readdirSync(folder), before);
  assert.equal((await cli(['embed', 'a.glb', 'b.glb', '--id', '1', '--key', 'key.json', '--dry-run'])).status, 1, 'what would be refused is');
});

test('--jobs hands every option to its threads', async (t) => {
  const { folder, cli } = await workspace(t);
  const args = ['embed', 'a.glb', 'b.glb', '--id', '1', '--key', 'key.json', '--salt', 'chair', '--strength', 'strong'];
  assert.equal((await cli([...args, '--out-dir', 'one'])).status, 0);
  assert.equal((await cli([...args, '--out-dir', 'two', '--jobs', '2'])).status, 0);
  assert.deepEqual(readFileSync(join(folder, 'two/b.glb')), readFileSync(join(folder, 'one/b.glb')));
  const read = await cli(['extract', 'two/*.glb', '--key', 'key.json', '--salt', 'chair', '--jobs', '2', '--json']);
  assert.deepEqual(read.json.map(({ id }) => id), ['0000000000000001', '0000000000000001']);
  assert.equal((await cli(['extract', 'two/*.glb', '--key', 'key.json', '--jobs', '2'])).status, 3, 'another salt is another mark');
});

/** Output of a command line run on a terminal. */
async function onTerminal(folder, args, env) {
  const command = [process.execPath, cliFile, ...args].map((word) => `'${word}'`).join(' ');
  return (await run('script', ['-qec', command, join(folder, 'typescript')], { cwd: folder, env })).stdout.toString();
}

test('on a terminal there are a progress bar and colours, unless NO_COLOR is set', { skip: await skipWithout('script') }, async (t) => {
  const { folder, cli } = await workspace(t);
  const embed = ['embed', 'a.glb', 'b.glb', '--out-dir', 'out', '--id', '1', '--key', 'key.json', '--force'];
  // CI, TMUX, COLORTERM and others change what Node says of a terminal's colours: only these two are given.
  const { PATH, HOME } = process.env;
  const free = { ...Object.fromEntries(Object.keys(process.env).map((name) => [name, undefined])), TERM: 'xterm', PATH, HOME };
  for (const jobs of ['1', '2']) assert.match(await onTerminal(folder, [...embed, '--jobs', jobs], free), /\[[#-]{24}\] +\d+ %.*\.glb: \w+/);
  assert.doesNotMatch(await onTerminal(folder, [...embed, '--quiet'], free), /\[[#-]{24}\]/);
  assert.match(await onTerminal(folder, ['extract', 'out/a.glb', '--key', 'key.json'], free), /\x1b\[32mmatch/);
  assert.doesNotMatch(await onTerminal(folder, ['extract', 'out/a.glb', '--key', 'key.json'], { ...free, NO_COLOR: '1' }), /\x1b\[\d+m/);
  const piped = await cli(['extract', 'out/a.glb', '--key', 'key.json'], { env: free });
  assert.doesNotMatch(`${piped.stdout}${piped.stderr}`, /[\x1b\r]/, 'neither in a pipe');
});

test('inspect says seams, compression, capacity and cells per node', async (t) => {
  const { cli } = await workspace(t);
  const [report] = (await cli(['inspect', 'a.glb', '--json'])).json;
  assert.equal(report.seamVertices, report.vertices - report.weldedVertices);
  assert.equal(report.sizeBytes, model.length);
  assert.deepEqual(report.compression, []);
  assert.equal(report.perNode[0].cells, report.cells);
  assert.ok(report.capacity.length > 0);
  assert.match((await cli(['inspect', 'a.glb'])).stdout.toString(), /compression: none/);
});
