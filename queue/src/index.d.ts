// SPDX-License-Identifier: MIT
// Types of the package `quadmark-queue`.
import type { Redis } from 'ioredis';
import type { EmbedOptions, ErrorCode, KeyInput } from 'quadmark';

export const DEFAULT_REDIS: string;
export const DEFAULT_QUEUE: string;
/** Seconds that a killed worker keeps others from its jobs. */
export const LOCK_SECONDS: number;
/** Seconds for one model, which is then given up. */
export const TIME_LIMIT_SECONDS: number;
/** Tries of a job whose failure may pass, and milliseconds before the second, doubled with each. */
export const RETRIES: Readonly<{ attempts: number; backoff: number }>;

/** Connects to Redis by a URL or the path of a socket; fails with `io`. Call disconnect() at the end. */
export function connect(url?: string): Promise<Redis>;

/** A model: names relative to the roots. */
export interface Item { input: string; output: string }

/** Models directly in a folder, anywhere below one, or named in a text file. */
export function fromFolder(folder: string): Promise<Item[]>;
export function fromBucket(folder: string, prefix?: string): Promise<Item[]>;
export function fromList(file: string): Promise<Item[]>;

export interface EnqueueRequest {
  queue: string;
  models: Item[];
  /** Roots on this machine; workers have their own. They must lie apart. */
  inRoot: string;
  outRoot: string;
  key: KeyInput;
  /** Exactly one; the image is a PNG. */
  mark: { id?: string; text?: string; image?: Uint8Array };
  options?: Pick<EmbedOptions, 'strength' | 'salt' | 'maxError' | 'maxSlide'>;
  /** Name of the report below outRoot. Default: made from the run's id. */
  report?: string;
  attempts?: number;
  backoff?: number;
}

/**
 * Queues a job per model and one for the report. Equal models, key, mark, options, version and output are one job,
 * however often they are queued: what was marked and still is there is not marked again.
 */
export function enqueue(redis: Redis, request: EnqueueRequest): Promise<{
  run: string; report: string;
  /** Models of the run; those queued now; those that were there. */
  jobs: number; added: number; earlier: number;
}>;

export interface WorkerRequest {
  queue: string;
  inRoot: string;
  outRoot: string;
  /** Directory of key files; the right one is found by its fingerprint. */
  keys: string;
  /** Models at once, in a process each. Default 1. */
  concurrency?: number;
  lockSeconds?: number;
  timeLimit?: number;
  onDone?: (done: Item & { error?: string }) => void;
}

/** Starts taking models. close() finishes those at work. */
export function startWorker(redis: Redis, request: WorkerRequest): Promise<{ close(): Promise<void> }>;

export interface Status {
  waiting: number; delayed: number; active: number; completed: number; failed: number;
  working: { input: string; progress: unknown }[];
}
export function status(redis: Redis, queue: string): Promise<Status>;

export function runStatus(redis: Redis, queue: string, run: string): Promise<{
  models: number; finished: number; reported: boolean; failed: string | null;
  summary: { models: number; marked: number; failed: number; lost: number } | null;
} | null>;

export interface DeadLetter extends Item {
  job: string; attempts: number; when: string;
  error: { code: ErrorCode; message: string };
}
export function deadLetters(redis: Redis, queue: string): Promise<DeadLetter[]>;

/** Has dead letters (all, or those of the given jobs) tried again; the number of them. */
export function retryDead(redis: Redis, queue: string, ids?: string[]): Promise<number>;
