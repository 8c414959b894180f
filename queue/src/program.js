// SPDX-License-Identifier: MIT
// The command line: what it takes, and what it prints.
import { readFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { Command, CommanderError, InvalidArgumentError, Option } from 'commander';
import { ERROR_EXIT_STATUS, QuadmarkError } from 'quadmark';
import { connect, DEFAULT_QUEUE, DEFAULT_REDIS } from './connection.js';
import { readInput } from './files.js';
import { deadLetters, retryDead, runStatus, status } from './look.js';
import { enqueue, RETRIES } from './produce.js';
import { fromBucket, fromFolder, fromList } from './sources.js';
import { LOCK_SECONDS, startWorker, TIME_LIMIT_SECONDS } from './work.js';

const { version } = JSON.parse(readFileSync(new URL('../package.json', import.meta.url), 'utf8'));

const POLL_MILLIS = 200;

function parsePositive(text) {
  const number = Number(text);
  if (text.trim() === '' || !(number > 0)) throw new InvalidArgumentError('Not a number above 0.');
  return number;
}

/** Models and the root that their names are relative to. */
async function sourceOf({ folder, bucket, prefix, list, in: inRoot }) {
  if ([folder, bucket, list].filter((given) => given !== undefined).length !== 1) {
    throw new QuadmarkError('bad_option', 'give exactly one of --folder, --bucket and --list');
  }
  if (folder !== undefined) return { models: await fromFolder(folder), inRoot: folder };
  if (bucket !== undefined) return { models: await fromBucket(bucket, prefix), inRoot: bucket };
  return { models: await fromList(list), inRoot: inRoot ?? dirname(list) };
}

/** Progress of a run on a terminal until its report is written; the report's summary. */
async function waitForRun(redis, queue, run) {
  for (;;) {
    const { models, finished, reported, failed, summary } = await runStatus(redis, queue, run);
    if (process.stderr.isTTY) process.stderr.write(`\r${finished} of ${models} models`);
    if (reported || failed !== null) {
      if (process.stderr.isTTY) process.stderr.write('\n');
      if (failed !== null) throw new QuadmarkError('io', `the report was not written: ${failed}`);
      return summary;
    }
    await sleep(POLL_MILLIS);
  }
}

const describeProgress = (progress) =>
  (progress?.stage === undefined ? 'begun' : `${progress.stage}, ${Math.round(progress.done * 100)} %`);

const COMMANDS = {
  async add(redis, options, print) {
    const { queue, out: outRoot, key, id, text, image, strength, salt, maxError, maxSlide, report, attempts, backoff } = options;
    const settings = Object.fromEntries(Object.entries({ strength, salt, maxError, maxSlide }).filter(([, value]) => value !== undefined));
    const added = await enqueue(redis, {
      queue, ...(await sourceOf(options)), outRoot, report, attempts, backoff, options: settings,
      key: (await readInput(key)).toString(),
      mark: { id, text, image: image === undefined ? undefined : await readInput(image) },
    });
    if (!options.wait) {
      print(added, `run ${added.run}: ${added.added} models queued, ${added.earlier} were there already`);
      return 0;
    }
    const summary = await waitForRun(redis, queue, added.run);
    print({ ...added, ...summary }, `${summary.marked} models marked, ${summary.failed} failed, report ${added.report}`);
    return summary.marked === summary.models ? 0 : 1;
  },

  async work(redis, { queue, in: inRoot, out: outRoot, keys, concurrency, lock, timeLimit }, print) {
    const stopped = new Promise((resolve) => {
      let seen = 0;
      // The second one ends a worker that waits for a model, or for a Redis that is gone.
      const receive = () => (++seen > 1 ? process.exit(1) : resolve());
      for (const signal of ['SIGTERM', 'SIGINT']) process.on(signal, receive);
    });
    const worker = await startWorker(redis, {
      queue, inRoot, outRoot, keys, concurrency, lockSeconds: lock, timeLimit,
      onDone: ({ input, output, error }) => print({ input, output, error }, error ? `${input}: ${error}` : `${input} -> ${output}`),
    });
    print({ ready: true }, 'waiting for models');
    await stopped;
    await worker.close();
    return 0;
  },

  async status(redis, { queue }, print) {
    const found = await status(redis, queue);
    const { working, ...counts } = found;
    print(found, [
      Object.entries(counts).map(([name, count]) => `${count} ${name}`).join(', '),
      ...working.map(({ input, progress }) => `  ${input}: ${describeProgress(progress)}`),
    ].join('\n'));
    return 0;
  },

  async dead(redis, { queue }, print) {
    const letters = await deadLetters(redis, queue);
    for (const letter of letters) {
      print(letter, `${letter.job}  ${letter.input}: ${letter.error.message} (${letter.error.code}, ${letter.attempts} tries)`);
    }
    return 0;
  },

  async retry(redis, { queue, jobs }, print) {
    const count = await retryDead(redis, queue, jobs.length > 0 ? jobs : undefined);
    print({ retried: count }, `${count} models are tried again`);
    return 0;
  },
};

/**
 * Runs one command line.
 * @param argv  arguments after the program's name
 * @return the exit status: 0 done, 1 failure or models that failed, 2 usage
 */
export async function run(argv) {
  let exit = 0;
  const program = new Command('quadmark-queue')
    .description('Marks 3D models on many machines, over Redis.')
    .version(version)
    .exitOverride()
    .configureHelp({ helpWidth: 100 });

  const define = (name, description) => {
    const command = program.command(name).description(description).exitOverride().configureHelp({ helpWidth: 100 })
      .addOption(new Option('--redis <url>', 'where Redis is: URL or path of a socket; logins belong in the variable')
        .env('QUADMARK_REDIS_URL').default(DEFAULT_REDIS))
      .option('--queue <name>', 'name of the queue', DEFAULT_QUEUE)
      .option('--json', 'print JSON objects, one a line (default: sentences)');
    return command.action(async (...given) => {
      const options = { ...given.at(-2), jobs: Array.isArray(given[0]) ? given[0] : [] };
      const print = (object, sentence) => process.stdout.write(`${options.json ? JSON.stringify(object) : sentence}\n`);
      let redis;
      try {
        redis = await connect(options.redis);
        exit = await COMMANDS[name](redis, options, print);
      } catch (error) {
        const { code, message } = error instanceof QuadmarkError ? error : { code: 'internal', message: error.stack };
        if (options.json) print({ error: { code, message } });
        process.stderr.write(`quadmark-queue ${name}: ${message} (${code})\n`);
        exit = ERROR_EXIT_STATUS[code] ?? 1;
      } finally {
        redis?.disconnect();
      }
    });
  };

  define('add', 'queue models to mark; those marked before, or queued already, are not queued again')
    .option('--folder <dir>', 'all models directly in a folder')
    .option('--bucket <dir>', 'all models anywhere below a folder')
    .option('--prefix <text>', 'of these, those whose path begins so (default: all)')
    .option('--list <file>', 'the models named in a file, one a line')
    .option('--in <dir>', 'what the names in the list are relative to (default: the list\'s folder)')
    .requiredOption('--out <dir>', 'where marked models and the report go, under the same names; needed')
    .requiredOption('--key <file>', 'key file, needed; workers find their own copy by its fingerprint')
    .option('--id <hex>', '64-bit ID to embed')
    .option('--text <text>', 'text to embed')
    .option('--image <logo.png>', 'picture to embed')
    .addOption(new Option('--strength <preset>', 'how much the mark may change and withstand (default: standard)')
      .choices(['invisible', 'standard', 'strong']))
    .option('--salt <text>', 'name of the asset, for reading too (default: none)')
    .option('--max-error <share>', 'largest displacement, fraction of the diagonal (default: the strength\'s)', parsePositive)
    .option('--max-slide <share>', 'largest displacement along the surface (default: the strength\'s)', parsePositive)
    .option('--report <name>', 'name of the report below --out (default: quadmark-report-RUN.json)')
    .option('--attempts <count>', 'tries of a model whose failure may pass', parsePositive, RETRIES.attempts)
    .option('--backoff <ms>', 'before the second try; doubles with each', parsePositive, RETRIES.backoff)
    .option('--wait', 'until the report is written; status 1 when models failed (default: off)');
  define('work', 'mark queued models until SIGTERM')
    .requiredOption('--in <dir>', 'where the models are on this machine; needed')
    .requiredOption('--out <dir>', 'where marked models go on this machine; needed')
    .requiredOption('--keys <dir>', 'key files of this machine; needed')
    .option('--concurrency <count>', 'models at once, in a process each', parsePositive, 1)
    .option('--lock <seconds>', 'after which others take over from a worker that was killed', parsePositive, LOCK_SECONDS)
    .option('--time-limit <seconds>', 'for one model, which is then given up', parsePositive, TIME_LIMIT_SECONDS);
  define('status', 'how far the queue is');
  define('dead', 'list the models that could not be marked');
  define('retry', 'have models that could not be marked tried again').argument('[jobs...]', 'ids as listed by dead (default: all)');

  try {
    await program.parseAsync(argv, { from: 'user' });
    return exit;
  } catch (error) {
    if (error instanceof CommanderError) return error.exitCode === 0 ? 0 : 2;
    throw error;
  }
}
