// SPDX-License-Identifier: MIT
// Types of the package `quadmark-server`.
import type { FastifyServerOptions } from 'fastify';

export interface ServerOptions {
  /** Directory of the keys: the key with the id ID is ID.json there. */
  keys: string;
  /** Address to bind to. Default "127.0.0.1": this machine alone. */
  host?: string;
  /** 0 takes a free one. Default 8080. */
  port?: number;
  /** Calls worked on at once, a thread each. Default: one per processor. */
  threads?: number;
  /** Requests that may wait for a thread; more are refused with 503. Default: four per processor. */
  queue?: number;
  /** Largest request in bytes, all files of it together; more is refused with 413. Default 64 MiB. */
  bodyLimit?: number;
  /** Seconds from the headers of a request to its answer; then its work is ended and it gets 408. Default 60. */
  timeLimit?: number;
  /** Resident memory above which requests are refused with 503; 0 = no limit. Default: three quarters of the machine's. */
  maxRssBytes?: number;
  /** As fastify takes it; false logs nothing. Default: one line per answer on standard output. */
  logger?: FastifyServerOptions['logger'];
}

export const DEFAULTS: Readonly<Required<Omit<ServerOptions, 'keys'>>>;

/** Starts the endpoint; fails with a QuadmarkError (`bad_option`, `io`) or as listening fails. */
export function serve(options: ServerOptions): Promise<{
  /** Where it listens. */
  url: string;
  /** Refuses new work, finishes what runs, closes. */
  close(): Promise<void>;
}>;

/** The same until SIGTERM or SIGINT. A second signal ends the process at once. */
export function serveUntilSignal(options: ServerOptions, onReady: (url: string) => void): Promise<void>;
