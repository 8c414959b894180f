// SPDX-License-Identifier: MIT
// A bar that rewrites its own line, on terminals only.
import { basename } from 'node:path';

const WIDTH = 24;
const INTERVAL = 50;  // milliseconds between drawings

export class ProgressBar {
  #stream;
  #total = 1;
  #done = 0;
  #running = new Map();  // input -> share done
  #width = 0;
  #drawn = -Infinity;

  /** @param stream  a terminal */
  constructor(stream) {
    this.#stream = stream;
  }

  /** How many inputs the run has. */
  expect(total) {
    this.#total = Math.max(1, total);
  }

  /** One input is `done` (0 to 1) of its way. */
  update(input, stage, done) {
    this.#running.set(input, done);
    const now = performance.now();
    if (now - this.#drawn < INTERVAL) return;
    this.#drawn = now;
    const share = Math.min(1, (this.#done + [...this.#running.values()].reduce((sum, part) => sum + part, 0)) / this.#total);
    const bar = '#'.repeat(Math.round(share * WIDTH)).padEnd(WIDTH, '-');
    const counted = this.#total > 1 ? ` ${this.#done} of ${this.#total}` : '';
    const text = `[${bar}] ${String(Math.round(share * 100)).padStart(3)} %${counted}  ${basename(input)}: ${stage}`
      .slice(0, (this.#stream.columns ?? 80) - 1);
    this.#stream.write(`\r${text.padEnd(this.#width)}`);
    this.#width = text.length;
  }

  /** Takes the line away before something else is printed; an input that ended counts as done. */
  clear(ended) {
    if (ended !== undefined) {
      this.#running.delete(ended);
      ++this.#done;
    }
    if (this.#width === 0) return;
    this.#stream.write(`\r${' '.repeat(this.#width)}\r`);
    this.#width = 0;
  }
}
