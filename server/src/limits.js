// SPDX-License-Identifier: MIT
// How much at once: requests are admitted before their bodies are read, so that what is held in memory is bounded by
// (threads + queue) * body limit.
import { busy, HttpError, tooLarge } from './errors.js';

export class Admission {
  #places;
  #taken = 0;
  #draining = false;
  #emptied = [];

  /** @param places  requests that may be read, waiting or worked on at once */
  constructor(places) {
    this.#places = places;
  }

  get taken() {
    return this.#taken;
  }

  get draining() {
    return this.#draining;
  }

  /** Takes a place; the function it returns gives it back. Fails with 503. */
  enter() {
    if (this.#draining) throw busy('the server is shutting down', { connection: 'close' });
    if (this.#taken >= this.#places) throw busy('all threads are at work and the queue is full');
    ++this.#taken;
    let inside = true;
    return () => {
      if (!inside) return;
      inside = false;
      if (--this.#taken === 0) for (const resolve of this.#emptied.splice(0)) resolve();
    };
  }

  /** Admits nobody any more and waits for those inside. */
  async drain() {
    this.#draining = true;
    if (this.#taken > 0) await new Promise((resolve) => { this.#emptied.push(resolve); });
  }
}

/** Why a request was stopped when its client went away: nobody reads this answer, the log counts it as 499. */
class ClientGone extends HttpError {
  constructor() {
    super(499, 'aborted', 'the client closed the connection');
  }
}

/**
 * The life of one admitted request: aborted at the time limit, or when its client goes away.
 * @return AbortController
 */
export function limitLife(reply, seconds) {
  const controller = new AbortController();
  const timer = setTimeout(() => {
    controller.abort(new HttpError(408, 'aborted', `stopped at the time limit of ${seconds} s`, { connection: 'close' }));
  }, seconds * 1000);
  reply.raw.once('close', () => {
    clearTimeout(timer);
    if (!reply.raw.writableFinished) controller.abort(new ClientGone());
  });
  return controller;
}

/** Refuses what says itself that it is too large, before reading any of it. */
export function checkDeclaredSize(request, limit) {
  if (Number(request.headers['content-length'] ?? 0) > limit) throw tooLarge(limit);
}
