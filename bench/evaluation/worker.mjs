// SPDX-License-Identifier: MIT
// The native worker as a child process: jobs in, rows out.
import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { workerFile } from './paths.mjs';

/** Runs the worker to its end and returns the JSON object it prints: for its commands about, mark and read. */
export function askWorker(...words) {
  return new Promise((resolve, reject) => {
    const child = spawn(workerFile, words, { stdio: ['ignore', 'pipe', 'pipe'] });
    let out = '', err = '';
    child.stdout.on('data', (chunk) => { out += chunk; });
    child.stderr.on('data', (chunk) => { err += chunk; });
    child.on('error', () => reject(new Error(`${workerFile} cannot be run: cmake --preset release && cmake --build --preset release --target quadmark_evaluate`)));
    child.on('close', (status) => (status === 0 ? resolve(JSON.parse(out)) : reject(new Error(err.trim() || `quadmark_evaluate ${words[0]}: exit status ${status}`))));
  });
}

/** A worker that stays for many jobs. */
export class Worker {
  #child = null;
  #lines;
  #onLine;
  #onEnd;

  #start() {
    const child = spawn(workerFile, ['run'], { stdio: ['pipe', 'pipe', 'inherit'] });
    this.#child = child;
    child.stdin.on('error', () => {});  // it ended: said below
    this.#lines = createInterface({ input: child.stdout });
    this.#lines.on('line', (line) => this.#onLine?.(JSON.parse(line)));
    const ended = (why) => {
      if (this.#child !== child) return;
      this.#child = null;
      this.#onEnd?.(new Error(why));
    };
    child.on('error', (error) => ended(error.message));
    child.on('close', (status, signal) => ended(`the worker ended (${signal ?? `status ${status}`})`));
  }

  /**
   * Runs a job (evaluate.cpp), with onRow(row) for each of its rows.
   * @throws Error of the worker's words; the worker is started again for the next job where it ended.
   */
  run(job, onRow) {
    if (!this.#child) this.#start();
    return new Promise((resolve, reject) => {
      let failure = null;
      const end = (error) => {
        this.#onLine = this.#onEnd = undefined;
        if (error) reject(error);
        else resolve();
      };
      this.#onEnd = end;
      this.#onLine = (line) => {
        if (line.done) end(failure);
        else if (line.error !== undefined) failure = new Error(line.error);
        else onRow(line);
      };
      this.#child.stdin.write(`${JSON.stringify(job)}\n`);
    });
  }

  stop() {
    const child = this.#child;
    this.#child = null;
    child?.kill();
    this.#onEnd?.(new Error('the worker was stopped'));
  }
}
