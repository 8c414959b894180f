// SPDX-License-Identifier: MIT
// What the command line prints: one JSON object per input or a few lines for people on standard output, logs and
// errors on standard error.
import { QuadmarkError } from '../error.js';
import { exitOfError } from './exit.js';

export class Output {
  #command;
  #json;
  #quiet;
  #progressWidth = 0;

  constructor(command, options) {
    this.#command = command;
    this.#json = Boolean(options.json);
    this.#quiet = Boolean(options.quiet);
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
    this.#clearProgress();
    if (this.#json) {
      process.stdout.write(`${JSON.stringify({ command: this.#command, ...report })}\n`);
    } else if (!this.#quiet) {
      stream.write(`${lines.join('\n')}\n`);
    }
    if (!this.#quiet) for (const warning of report.warnings ?? []) this.log(`warning: ${warning}`);
  }

  /** One input failed, or (input null) the command as a whole. Returns the exit status. */
  failure(input, error) {
    this.#clearProgress();
    const known = error instanceof QuadmarkError ? error : new QuadmarkError('internal', error?.stack ?? String(error));
    if (this.#json) {
      const { code, message } = known;
      process.stdout.write(`${JSON.stringify({ command: this.#command, input, error: { code, message } })}\n`);
    }
    const place = input === null ? '' : `${input === '-' ? 'standard input' : input}: `;
    process.stderr.write(`quadmark ${this.#command}: ${place}${known.message} (${known.code})\n`);
    return exitOfError(known);
  }

  log(message) {
    if (!this.#quiet) process.stderr.write(`quadmark ${this.#command}: ${message}\n`);
  }

  /** onProgress for the library: a line that rewrites itself, on terminals only. */
  get onProgress() {
    if (this.#quiet || !process.stderr.isTTY) return undefined;
    return ({ stage, done }) => {
      const text = `${stage} ${Math.round(done * 100)} %`;
      process.stderr.write(`\r${text.padEnd(this.#progressWidth)}`);
      this.#progressWidth = text.length;
    };
  }

  #clearProgress() {
    if (this.#progressWidth === 0) return;
    process.stderr.write(`\r${' '.repeat(this.#progressWidth)}\r`);
    this.#progressWidth = 0;
  }
}

/** Milliseconds since `start` (performance.now()), to the tenth. */
export const millisSince = (start) => Math.round((performance.now() - start) * 10) / 10;
