// SPDX-License-Identifier: MIT
/**
 * Attacks and generated models, for tests and demonstrations: a module of its own, so that the product never carries it.
 *
 * @module quadmark/lab
 */
import type { Bytes, Resources, WasmSource } from './index.js';

/** How large a mesh is. */
export interface Sizes {
  vertices: number;
  faces: number;
}

/** What to do to a model. */
export interface AttackRequest {
  /** One of attackKinds(). */
  kind: string;
  /** What it means depends on the kind: amplitude, share, bits, ... */
  amount?: number;
  variant?: string;
  iterations?: number;
  seed?: number;
  /** Of the result, a new plain file. Default "ply". */
  format?: 'ply' | 'glb';
  resources?: Resources;
}

/** Damages a model the way pipelines and adversaries do. */
export function attack(model: Bytes, request: AttackRequest): Promise<{ bytes: Uint8Array; before: Sizes; after: Sizes }>;

/** Which model to make. */
export interface GenerateRequest {
  /** "sculpture", "part", "icosphere", ... */
  name: string;
  /** Rough number of vertices; default 35 000. */
  vertices?: number;
  seed?: number;
  format?: 'ply' | 'glb';
}

/** Makes a model. Equal arguments give equal bytes. */
export function generate(request: GenerateRequest): Promise<{ bytes: Uint8Array } & Sizes>;

/** All kinds of attack, with a line on each. */
export function attackKinds(): Promise<{ kind: string; description: string }[]>;

/** Optional: loads the laboratory's module ahead of the first call, or from another place. */
export function load(request?: { wasm?: WasmSource | Promise<WasmSource> }): Promise<void>;
/** Frees its memory. */
export function unload(): void;
