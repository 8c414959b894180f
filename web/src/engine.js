// SPDX-License-Identifier: MIT
// The page's side of a worker: one job at a time, cancelled by ending the thread (a running search has no ears).
import { startWorker } from './platform/served.js';

export class Engine {
  #worker = null;
  #reject = null;

  /**
   * Runs a job; one that still runs is cancelled first.
   * @param request     what worker/index.js takes
   * @param onProgress  ({ stage, done }) => void
   * @return what the worker answers; rejects with an AbortError when cancelled
   */
  run(request, onProgress = () => {}) {
    this.cancel();
    const worker = (this.#worker ??= startWorker());
    return new Promise((resolve, reject) => {
      this.#reject = reject;
      const finish = (answer) => {
        this.#reject = null;
        worker.onmessage = worker.onerror = worker.onmessageerror = null;
        resolve(answer);
      };
      const fail = (message) => {
        this.end();
        finish({ type: 'problem', about: 'page', code: 'internal', message });
      };
      worker.onmessage = ({ data }) => (data.type === 'progress' ? onProgress(data) : finish(data));
      worker.onerror = (event) => fail(event.message ?? 'the detector could not be started');
      worker.onmessageerror = () => fail('the answer of the detector could not be read');
      worker.postMessage(request);
    });
  }

  /** True while a job runs. */
  get busy() {
    return this.#reject !== null;
  }

  cancel() {
    if (!this.busy) return;
    this.end();
    this.#reject(new DOMException('cancelled', 'AbortError'));
    this.#reject = null;
  }

  /** Ends the thread, if there is one; the next job starts another. */
  end() {
    if (!this.#worker) return;
    this.#worker.onmessage = this.#worker.onerror = this.#worker.onmessageerror = null;
    this.#worker.terminate();
    this.#worker = null;
  }
}
