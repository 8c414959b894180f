// SPDX-License-Identifier: MIT
// What the command line prints: one JSON object per input or a few lines for people on standard output, logs and
// errors on standard error.
import { QuadmarkError } from '../error.js';
import { exitOfError } from './exit.js';
import { ProgressBar } from './progress.js';

const COLOURS = { good: 32, doubtful: 33, bad: 31 };

/** Coloured text for terminals that show colours; NO_COLOR is asked by Node itself. */
export function painted(stream, colour, text) {
  return stream.isTTY && stream.hasColors() ? `\x1b[${COLOURS[colour]}m${text}\x1b[0m` : text;
}

export class Output {
  #command;
  #json;
  #quiet;
  #dryRun;
  #bar = null;

  constructor(command, options) {
    this.#command = command;
    this.#json = Boolean(options.json);
    this.#quiet = Boolean(options.quiet);
    this.#dryRun = Boolean(options.dryRun);
    if (!this.#quiet && process.stderr.isTTY) this.#bar = new ProgressBar(process.stderr);
  }

  /** How many inputs are to come, for the progress bar. */
  expect(count) {
    this.#bar?.expect(count);
  }

  get json() {
    return this.#json;
  }

  /**
   * One input is done.
   * @param report  object for --json, without `command`
   * @param lines   for people
   * @param stream  where these go: standard error when standard output carries the file itself
   */
  result(report, lines, stream = process.stdout) {
    this.#bar?.clear(report.input);
    if (this.#json) {
      process.stdout.write(`${JSON.stringify({ command: this.#command, ...report, ...(this.#dryRun ? { dryRun: true } : {}) })}\n`);
    } else if (!this.#quiet) {
      stream.write(`${lines.join('\n')}\n${this.#dryRun ? '  (dry run: nothing was written)\n' : ''}`);
    }
    if (!this.#quiet) for (const warning of report.warnings ?? []) this.log(`warning: ${warning}`);
  }

  /** One input failed, or (input null) the command as a whole. `more` joins the JSON. Returns the exit status. */
  failure(input, error, more = {}) {
    this.#bar?.clear(input ?? undefined);
    const known = error instanceof QuadmarkError ? error : new QuadmarkError('internal', error?.stack ?? String(error));
    if (this.#json) {
      const { code, message } = known;
      process.stdout.write(`${JSON.stringify({ command: this.#command, input, ...more, error: { code, message } })}\n`);
    }
    const place = input === null ? '' : `${input === '-' ? 'standard input' : input}: `;
    process.stderr.write(`quadmark ${this.#command}: ${place}${painted(process.stderr, 'bad', known.message)} (${known.code})\n`);
    return exitOfError(known);
  }

  log(message) {
    this.#bar?.clear();
    if (!this.#quiet) process.stderr.write(`quadmark ${this.#command}: ${message}\n`);
  }

  /** onProgress of an input for the library; undefined where nothing is shown. */
  progressOf(input) {
    return this.#bar ? ({ stage, done }) => this.#bar.update(input, stage, done) : undefined;
  }
}

/** Milliseconds since `start` (performance.now()), to the tenth. */
export const millisSince = (start) => Math.round((performance.now() - start) * 10) / 10;
