// SPDX-License-Identifier: MIT
// The evaluation in small: all experiments, interrupted and resumed, and the document of what they measured. How well the
// schemes do is not asserted here, but that every cell was measured, and how often.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { appendFileSync, existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { recordedContext } from '../bench/evaluation/context.mjs';
import { writeDocument } from '../bench/evaluation/document.mjs';
import { experiments } from '../bench/evaluation/experiments.mjs';
import { workerFile } from '../bench/evaluation/paths.mjs';
import { COLUMNS, Rows } from '../bench/evaluation/rows.mjs';
import { repository, run, temporaryFolder } from './support/files.mjs';

const command = join(repository, 'bench/evaluate');
const built = existsSync(workerFile);
const skip = built ? false : `${workerFile} is not built`;
const linesOf = (file) => (existsSync(file) ? readFileSync(file, 'utf8').split('\n').length - 1 : 0);

/** Runs the command until its results have some lines, then interrupts it as Ctrl-C does; its exit status. */
async function interrupted(args, file, lines) {
  const child = spawn(command, args, { stdio: ['ignore', 'ignore', 'inherit'] });
  const ended = new Promise((resolve) => { child.on('close', resolve); });
  while (linesOf(file) < lines && child.exitCode === null) await sleep(50);
  child.kill('SIGINT');
  return ended;
}

test('a quick evaluation measures every cell, whether or not it was interrupted', { skip }, async (t) => {
  const folder = temporaryFolder(t), file = join(folder, 'readings.csv');
  const args = ['--quick', '--out', folder];
  assert.equal(await interrupted(args, file, 20), 130);
  const before = new Rows(file).select();
  assert.ok(before.length >= 19, `${before.length} rows were kept`);

  const rest = await run(command, args);
  assert.equal(rest.status, 0, rest.stderr);
  const after = new Rows(file).select();
  assert.match(rest.stdout.toString(), new RegExp(`^${after.length - before.length} rows measured, ${after.length} in `));

  const { schemes } = JSON.parse((await run(workerFile, ['about'])).stdout);
  for (const { name } of schemes) assert.ok(after.some((row) => row.scheme === name && row.ber !== undefined), `${name} was read`);
  for (const row of after) assert.ok(row.outcome, JSON.stringify(row));
  const text = readFileSync(join(folder, 'evaluation.md'), 'utf8');
  for (const { title } of experiments) assert.ok(text.includes(`\n## ${title}\n`), title);
  assert.ok(!/not measured|undefined|NaN/.test(text), /.*(not measured|undefined|NaN).*/.exec(text)?.[0]);
  const report = readFileSync(join(folder, 'report.html'), 'utf8').replace(/base64,[^"]*/g, '');
  assert.ok(!/not measured|undefined|NaN/.test(report), /.{80}(not measured|undefined|NaN).{80}/.exec(report)?.[0]);

  const again = await run(command, [...args, '--document']);
  assert.equal(again.status, 0, again.stderr);
  assert.equal(readFileSync(join(folder, 'evaluation.md'), 'utf8'), text);
});

test('the committed document is the one of the committed rows', (t) => {
  const results = join(repository, 'bench/results/readings.csv');
  if (!existsSync(results)) return t.diagnostic('there are no committed results');
  const committed = readFileSync(join(repository, 'docs/evaluation.md'), 'utf8');
  const file = join(temporaryFolder(t), 'evaluation.md');
  writeDocument(file, recordedContext(join(repository, 'bench/results')));
  assert.equal(readFileSync(file, 'utf8'), committed);
});

test('rows survive a torn last line, commas, quotes and a second reading', (t) => {
  const file = join(temporaryFolder(t), 'readings.csv');
  const row = { scheme: 'a', settings: 'strength=1,bins=2', payload: 'id', model: 'm:1', seed: 2, attack: 'tool:say "hi"', outcome: 'failed', note: 'two\nlines, one' };
  const rows = new Rows(file);
  rows.add(row);
  rows.add({ ...row, seed: 10, outcome: 'exact', ber: 0, claim: 1.23456789e-9, note: undefined });
  assert.throws(() => rows.add(row), /two rows a, strength=1,bins=2/);
  assert.throws(() => rows.add({ ...row, seed: 3, colour: 1 }), /no column colour/);
  appendFileSync(file, 'a,b,id,m:1,3,none,exa');
  const again = new Rows(file);
  assert.deepEqual(again.select({ seed: 2 }), [{ ...row, note: 'two lines, one' }]);
  assert.equal(again.select({ seed: 10 })[0].claim, 1.2346e-9);
  assert.ok(again.has({ ...row, seed: 10 }) && !again.has({ ...row, seed: 3 }));
  again.sort();
  assert.deepEqual(readFileSync(file, 'utf8').split('\n').map((line) => line.split(',')[0]), ['scheme', 'a', 'a', '']);
  assert.equal(readFileSync(file, 'utf8').split('\n')[0], COLUMNS.join(','));
});

test('a worker says what is wrong with a job, and goes on', { skip }, async () => {
  const good = { scheme: 'robust', payload: 'id', model: 'sculpture:3000:1', seed: 1, mark: false };
  const jobs = [{ ...good, scheme: 'nobody' }, { ...good, payload: 'image:1' }, { ...good, settings: 'loud' }, { ...good, attacks: ['nothing:1'] },
    { ...good, attacks: ['noise:x'] }, { ...good, model: 'nowhere.glb' }, {}, { ...good, attacks: ['none', 'crop:1'] }];
  const { json } = await run(workerFile, ['run'], { input: jobs.map((job) => `${JSON.stringify(job)}\n`).join('') });
  const errors = json.filter((line) => line.error).map((line) => line.error);
  assert.equal(json.filter((line) => line.done).length, jobs.length);
  for (const [i, expected] of ['"nobody" is not one of robust, paper', 'neither id nor image:SIDE', 'expected "invisible"', '"nothing" is not one of', 'noise:x', 'cannot read', 'not found'].entries()) {
    assert.ok(errors[i].includes(expected), errors[i]);
  }
  assert.deepEqual(json.filter((line) => line.outcome).map(({ attack, outcome }) => [attack, outcome]), [['none', 'exact'], ['crop:1', 'failed']]);
});
