// SPDX-License-Identifier: MIT
// bench/evaluate: schemes x payloads x models x attacks x seeds. Rows and machine go to bench/results/, docs/evaluation.md and
// the table of tools in README.md are made of them. What has a row is not measured again: an interrupted run goes on where
// it stopped.
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { join, resolve } from 'node:path';
import { Command, InvalidArgumentError } from 'commander';
import { ProgressBar } from '../../node/src/cli/progress.js';
import { replaceTable } from '../support/table.mjs';
import { machineFile, recordedContext, rowsFile } from './context.mjs';
import { writeDocument } from './document.mjs';
import { experiments } from './experiments.mjs';
import { describeMachine } from './machine.mjs';
import { repository } from './paths.mjs';
import { writeReport } from './report.mjs';
import { Rows } from './rows.mjs';
import { openJobs, runJobs } from './runner.mjs';
import { shortTable } from './tools/tables.mjs';
import { askWorker } from './worker.mjs';

const FULL_SEEDS = 5;

function count(text) {
  const number = Number(text);
  if (!Number.isInteger(number) || number < 1) throw new InvalidArgumentError('expected a whole number from 1 on.');
  return number;
}

function experimentNamed(name, before = []) {
  const found = experiments.find((experiment) => experiment.name === name);
  if (!found) throw new InvalidArgumentError(`there are ${experiments.map((experiment) => experiment.name).join(', ')}.`);
  return [...before, found];
}

const program = new Command('bench/evaluate')
  .description('Measures the schemes of the product and those of other people. Rows that are there are not measured again.')
  .option('--quick', 'all experiments on two small generated models, one seed, within minutes; into build/evaluation/quick')
  .option('--experiment <name...>', `only these: ${experiments.map((experiment) => experiment.name).join(', ')}`, experimentNamed)
  .option('--jobs <n>', 'processes at once', count, availableParallelism())
  .option('--seeds <n>', `keys and payloads per cell (default: ${FULL_SEEDS}, with --quick 1)`, count)
  .option('--out <folder>', 'where the results go (default: bench/results, with --quick build/evaluation/quick)')
  .option('--anew', 'forget the rows that are there')
  .option('--add <csv...>', 'take rows that another machine measured')
  .option('--document', 'only make the document of the rows there are');
const options = program.parse().opts();

const chosen = options.experiment ?? experiments;
const seeds = Array.from({ length: options.seeds ?? (options.quick ? 1 : FULL_SEEDS) }, (_, i) => i + 1);
const folder = resolve(options.out ?? join(repository, options.quick ? 'build/evaluation/quick' : 'bench/results'));
const isPublished = !options.quick && !options.out;
const documentFile = isPublished ? join(repository, 'docs/evaluation.md') : join(folder, 'evaluation.md');
mkdirSync(folder, { recursive: true });

const interrupt = new AbortController();
process.once('SIGINT', () => interrupt.abort());
process.once('SIGTERM', () => interrupt.abort());

/** One step per job or tool; says now and then where it is when nobody watches. */
class Steps {
  #bar = process.stderr.isTTY ? new ProgressBar(process.stderr) : null;
  #total = 0;
  #done = 0;
  #said = performance.now();

  expect(steps) {
    this.#total += steps;
    this.#bar?.expect(this.#total);
  }

  update(label, share) {
    this.#bar?.update(label, 'measuring', share);
  }

  ended(label) {
    ++this.#done;
    this.#bar?.clear(label);
    if (this.#bar || performance.now() - this.#said < 30_000) return;
    this.#said = performance.now();
    console.error(`${this.#done} of ${this.#total}: ${label}`);
  }
}

async function measure(context, about) {
  const usual = new Map(about.schemes.map((scheme) => [scheme.name, scheme.usualSettings]));
  const label = (job) => `${job.scheme} ${job.model} ${job.seed}`;
  const progress = (done, job) => (done < 1 ? context.progress.update(label(job), done) : context.progress.ended(label(job)));
  const errors = [], tried = new Set();
  while (!context.signal.aborted) {
    const asked = chosen.flatMap((experiment) => experiment.jobs?.(context) ?? [])
      .map((job) => ({ ...job, settings: job.settings ?? usual.get(job.scheme) }));
    const open = openJobs(asked, context.rows).filter((job) => !tried.has(JSON.stringify(job)));
    if (open.length === 0) break;
    const jobs = open.filter(({ seed }) => seed === open[0].seed);  // later jobs of this seed may depend on them
    for (const job of jobs) tried.add(JSON.stringify(job));  // what failed fails again
    context.progress.expect(jobs.length);
    errors.push(...(await runJobs(jobs, { ...context, progress })));
  }
  for (const experiment of chosen) {
    if (!context.signal.aborted && experiment.run) errors.push(...(await experiment.run(context)));
  }
  return errors;
}

async function measureAll() {
  const about = await askWorker('about');
  if (options.anew) rmSync(rowsFile(folder), { force: true });
  const rows = new Rows(rowsFile(folder));
  for (const path of options.add ?? []) {
    for (const row of new Rows(path).select()) if (!rows.has(row)) rows.add(row);
  }
  const context = {
    quick: options.quick ?? false, seeds, schemes: about.schemes, rows, folder, parallel: options.jobs,
    signal: interrupt.signal, progress: new Steps(),
  };
  const machine = describeMachine(about);  // of the commit that measures, whatever is committed meanwhile
  const errors = await measure(context, about);
  rows.sort();
  if (rows.added > 0 || !existsSync(machineFile(folder))) {
    // Programs of experiments that were not chosen now keep their versions.
    const earlier = existsSync(machineFile(folder)) ? JSON.parse(readFileSync(machineFile(folder), 'utf8')).tools : {};
    const asked = interrupt.signal.aborted ? [] : await Promise.all(chosen.map((experiment) => experiment.tools?.(context) ?? {}));
    writeFileSync(machineFile(folder), `${JSON.stringify({ ...machine, tools: Object.assign(earlier, ...asked) }, null, 2)}\n`);
  }
  console.log(`${rows.added} rows measured, ${rows.select().length} in ${rowsFile(folder)}`);
  for (const error of errors) console.error(`not measured: ${error}`);
  return interrupt.signal.aborted ? 130 : errors.length > 0 ? 1 : 0;
}

if (!options.document) process.exitCode = await measureAll();
const recorded = recordedContext(folder, { quick: options.quick }), reportFile = join(folder, 'report.html');
writeDocument(documentFile, recorded);
if (isPublished) replaceTable(join(repository, 'README.md'), 'tools', shortTable(recorded));
console.log(documentFile);
if (!interrupt.signal.aborted) {  // who waits for the end of an interrupted run wants it now
  await writeReport(reportFile, recorded);
  console.log(reportFile);
}
