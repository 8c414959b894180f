// SPDX-License-Identifier: MIT
// The page's side of the worker: one check at a time, cancelled by ending the thread (a running search has no ears).

export class Detector {
  #worker = null;
  #reject = null;

  /**
   * Checks a model; a check that still runs is cancelled first.
   * @param request     what worker/index.js takes
   * @param onProgress  ({ stage, done }) => void
   * @return what the worker answers; rejects with an AbortError when cancelled
   */
  check(request, onProgress) {
    this.cancel();
    const worker = (this.#worker ??= new Worker(new URL('./worker/index.js', import.meta.url), { type: 'module' }));
    return new Promise((resolve, reject) => {
      this.#reject = reject;
      const finish = (answer) => {
        this.#reject = null;
        worker.onmessage = worker.onerror = worker.onmessageerror = null;
        resolve(answer);
      };
      const fail = (message) => {
        this.#end();
        finish({ type: 'problem', about: 'page', code: 'internal', message });
      };
      worker.onmessage = ({ data }) => (data.type === 'progress' ? onProgress(data) : finish(data));
      worker.onerror = (event) => fail(event.message ?? 'the detector could not be started');
      worker.onmessageerror = () => fail('the answer of the detector could not be read');
      worker.postMessage(request);
    });
  }

  /** True while a check runs. */
  get busy() {
    return this.#reject !== null;
  }

  cancel() {
    if (!this.busy) return;
    this.#end();
    this.#reject(new DOMException('cancelled', 'AbortError'));
    this.#reject = null;
  }

  #end() {
    if (!this.#worker) return;
    this.#worker.onmessage = this.#worker.onerror = this.#worker.onmessageerror = null;
    this.#worker.terminate();
    this.#worker = null;
  }
}
