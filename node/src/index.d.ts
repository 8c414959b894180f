// SPDX-License-Identifier: MIT
/**
 * Marks models, reads marks, makes keys. Plain data in, plain data out; importing instantiates nothing.
 *
 * @module quadmark
 */

/** Why a call failed; see the table in the README. */
export type ErrorCode =
  | 'bad_file' | 'unsupported_file' | 'bad_mesh' | 'bad_option' | 'bad_key' | 'bad_image' | 'capacity'
  | 'unsupported_version' | 'too_large' | 'io' | 'aborted' | 'internal';

/** Every failure of this package. `message` is one sentence naming the place. */
export class QuadmarkError extends Error {
  constructor(code: ErrorCode, message: string, options?: { cause?: unknown });
  readonly name: 'QuadmarkError';
  readonly code: ErrorCode;
}

/** Exit status of the command line by error code. */
export const ERROR_EXIT_STATUS: Readonly<Record<ErrorCode, 1 | 2>>;

/** Bytes of a model: GLB, glTF JSON or PLY, found by content. */
export type Bytes = Uint8Array | ArrayBuffer;

/** Files a glTF refers to, by URI exactly as the glTF spells it. */
export type Resources = Record<string, Bytes> | ReadonlyMap<string, Bytes>;

/** One bit per pixel: bits[y * width + x] is 1 for ink (dark), 0 for light; rows from the top. */
export interface BitImage {
  width: number;
  height: number;
  bits: Uint8Array;
}

/** A PNG file, thresholded on reading, or the pixels themselves. */
export type ImageInput = Bytes | { width: number; height: number; bits: Uint8Array | readonly number[] };

/** Parameters of the `paper` scheme; part of the key. */
export interface PaperParams {
  /** Decimal digits of the ratios that carry index (1) and piece (2): positions L..H, 2 to 9. */
  H1: number; L1: number; H2: number; L2: number;
  /** Largest displacement that forming a cell may cause, fraction of the bounding-box diagonal. */
  lambda: number;
  /** Largest deviation from a plane that reading tolerates, fraction of the longer diagonal. */
  tau: number;
  /** Neighbourhood radius in edges, 1 to 3. */
  k: number;
  width: number;
  height: number;
  [name: string]: unknown;
}

/** Content of a key file of scheme `paper`. Secret: whoever has it can read, and forge, the mark. */
export interface PaperKey {
  quadmark: 1;
  scheme: 'paper';
  /** Base64 of 32 random bytes. */
  secret: string;
  owner: string;
  params: PaperParams;
}

/** The same of scheme `robust`: what else it takes to read a mark is in the mark. */
export interface RobustKey {
  quadmark: 1;
  scheme: 'robust';
  secret: string;
  owner: string;
}

/** Content of a key file. */
export type Key = PaperKey | RobustKey;

/** A key, or its file as text or bytes. */
export type KeyInput = Key | string | Bytes;

/** How far a long call is. */
export interface Progress {
  /** "read", "search", "write", "verify" or "report". */
  stage: string;
  /** Share done of the whole call, 0 to 1. */
  done: number;
}

/** What long calls take. */
export interface CallOptions {
  /** Called synchronously between steps. An exception thrown here cancels the call and is passed on. */
  onProgress?: (progress: Progress) => void;
  /** Checked before the start and at every progress step; the call then fails with `aborted`. */
  signal?: AbortSignal;
}

/** Options that keys of scheme `robust` take; with others they fail with `bad_option`. */
export interface RobustOptions {
  /** Names the asset: marks under different salts have nothing in common. Reading takes the same one. */
  salt?: string;
}

export interface EmbedOptions extends CallOptions, RobustOptions {
  /** How much the mark may change and withstand. Default "standard". */
  strength?: 'invisible' | 'standard' | 'strong';
  /** Cap on every vertex's displacement, fraction of the bounding-box diagonal; default: the strength's own. */
  maxError?: number;
  /** Cap on its part along the surface. */
  maxSlide?: number;
  /** Damage the marked model in six ways and report which it withstands. */
  selfTest?: boolean;
}

/** Facts about what was done: the JSON object described in docs/format.md. */
export interface Report {
  warnings: string[];
  [name: string]: unknown;
}

/** What embed() needs: a key and exactly one payload. */
export interface EmbedRequest {
  key: KeyInput;
  /** The picture to embed: of the key's size, or with scheme `robust` up to 128 x 128. Exactly one of `image`, `id`, `text`. */
  image?: ImageInput;
  /** A 64-bit ID: 1 to 16 hexadecimal digits, or a bigint. With scheme `paper` for keys made for IDs. */
  id?: string | bigint;
  /** 1 to 64 bytes of UTF-8, scheme `robust` alone. Up to 8 bytes withstand as much as an ID. */
  text?: string;
  resources?: Resources;
  options?: EmbedOptions;
}

/** A marked model. */
export interface EmbedResult {
  /** The marked file: the input with other position components (and glTF min / max), nothing else. */
  bytes: Uint8Array;
  /** Those external buffers that changed, by the same URI. */
  resources: Record<string, Uint8Array>;
  report: Report;
}

/** Marks a model. Equal arguments give equal bytes on every platform. */
export function embed(model: Bytes, request: EmbedRequest): Promise<EmbedResult>;

/** What extract() needs: a key, and perhaps what to look for. */
export interface ExtractRequest {
  key: KeyInput;
  /** Compare with this image and let its agreement count for the verdict. */
  reference?: ImageInput;
  /** Scheme `robust`: is it this ID? A mark too faint to be read may still be told; another ID is no match. */
  expectId?: string | bigint;
  /** The same for a text. At most one of `reference`, `expectId`, `expectText`. */
  expectText?: string;
  resources?: Resources;
  options?: CallOptions & RobustOptions;
}

export interface ExtractedImage extends BitImage {
  /** Per pixel: 1 = could not be read (its bit is 0). */
  erased: Uint8Array;
  /** Per pixel: 0 (a guess) to 1 (certain). */
  confidence: Float32Array;
  /** The image as PNG, ink black, unread pixels mid grey. */
  png: Uint8Array;
  /** The confidence as PNG, 1 = white. */
  confidencePng: Uint8Array;
}

/** What was read, and what it is worth. */
export interface ExtractResult {
  /** "none" (no mark of this key) is a result, not an error. */
  verdict: 'match' | 'none' | 'inconclusive';
  /** Upper bound on the probability of this much agreement without this key's mark. */
  falsePositive: number;
  /** Always there for keys of scheme `paper`; null where a key of scheme `robust` found none. */
  image: ExtractedImage | null;
  /** 16 hexadecimal digits of an ID that was read with certainty; else null. */
  id: string | null;
  /** A text that was read with certainty; else null. */
  text: string | null;
  /** Scheme `robust`: per vertex how much its votes agree with the mark, -1 to 1, 0 = no vote; else empty. */
  evidence: Float32Array;
  report: Report;
}

/** Reads the mark that `key` describes. */
export function extract(model: Bytes, request: ExtractRequest): Promise<ExtractResult>;

/**
 * The 64-bit ID of a recipient, 16 hexadecimal digits: HKDF-SHA256 of the key's secret and the name. The same key and name
 * (trimmed, NFC, up to 256 bytes) always give the same ID; nobody without the key can tell whose one is.
 */
export function recipientId(key: KeyInput, recipient: string): Promise<string>;

/** 16 hexadecimal digits that tell keys apart and say nothing about the secret. */
export function keyFingerprint(key: KeyInput): Promise<string>;

/** Somebody who got a marked copy. Exactly one of `id` and `image`. */
export interface Candidate {
  recipient: string;
  id?: string | bigint;
  /** Of one size with scheme `paper`: the key's. */
  image?: ImageInput;
  /** The salt that the copy was marked with. */
  salt?: string;
}

/** What trace() needs: a key and everybody who has a copy. */
export interface TraceRequest {
  key: KeyInput;
  /** Everybody whose copy it could be, as a registry lists them. Equal ones count once. */
  candidates: Iterable<Candidate>;
  resources?: Resources;
  options?: CallOptions & {
    /** Called after each comparison with a candidate's mark. */
    onCandidate?: (progress: { done: number; candidates: number }) => void;
  };
}

/** A candidate and what speaks for it. */
export interface TracedCandidate {
  recipient: string;
  id: string | null;
  salt: string;
  /** Upper bound on the probability of this much agreement by chance ... */
  falsePositive: number;
  /**
   * ... and corrected for the choice among candidates: times their number where each was asked for (Bonferroni), times the
   * number of salts where the mark was read blindly, since the bound of such a reading holds for all 2^64 IDs already. At most 1.
   */
  corrected: number;
}

/** Whose copy a model is. */
export interface TraceResult {
  /** "match": `recipient` is named. "none": no mark, or one of somebody else (`id` says which). */
  verdict: 'match' | 'none' | 'inconclusive';
  recipient: string | null;
  id: string | null;
  /** Upper bound on the probability of naming anyone wrongly: the best candidate's `corrected`; match: up to 1e-6. */
  falsePositive: number;
  /** "read": the mark was read blindly; "compared": it was too faint for that, and each candidate's was asked for. */
  method: 'read' | 'compared';
  /** How many different marks there were to choose from. */
  trials: number;
  /** The best candidate and all others that chance does not explain (corrected up to 1e-4), best first. */
  candidates: TracedCandidate[];
}

/**
 * Names the recipient of a copy. Reads the mark first, once per salt; where it is too faint, compares with the mark of each
 * candidate, which costs as much as one extract() each.
 */
export function trace(model: Bytes, request: TraceRequest): Promise<TraceResult>;

/** Describes a model without a key: format, sizes, capacity. */
export function inspect(model: Bytes, request?: { resources?: Resources }): Promise<Report>;

/** URIs of the external buffers that a glTF needs as `resources`; empty for GLB and PLY. */
export function externalUris(model: Bytes): Promise<string[]>;

/** What a key of scheme `robust`, the default, needs: nothing but perhaps an owner. */
export interface RobustKeyRequest {
  /** Free text kept in the key file. */
  owner?: string;
  scheme?: 'robust';
}

/** Without `scheme`, any of the members below `owner` makes a key of scheme `paper`: no other key holds them. */
export interface PaperKeyRequest {
  owner?: string;
  scheme?: 'paper';
  /** Size of the image in pixels, 1 to 1024 a side ... */
  width?: number;
  height?: number;
  /** ... or a key for 64-bit IDs. */
  id?: boolean;
  /** First digit position that carries data, 2 to 8: 2 suits scans, 3 CAD models. Default 2. */
  L?: number;
  /** All four digit positions at once; default: as few as the payload needs, from L. */
  H1?: number; L1?: number; H2?: number; L2?: number;
  lambda?: number;
  tau?: number;
  k?: number;
  /** Only cells picked by the key carry data. */
  keyedCells?: boolean;
  /** Embedding also permutes the order of the vertices. */
  scrambleOrder?: boolean;
}

/** What createKey() takes. */
export type KeyRequest = PaperKeyRequest | RobustKeyRequest;

/** Makes a key around 32 random bytes of the platform's generator. */
export function createKey(request?: RobustKeyRequest): Promise<RobustKey>;
export function createKey(request: PaperKeyRequest): Promise<PaperKey>;

/** Checks a key and returns it in normal form; fails with `bad_key` or `unsupported_version`. */
export function parseKey(key: KeyInput): Promise<Key>;

/** Decodes a PNG and thresholds its luminance (0 to 1; default: Otsu's method picks it). */
export function decodeImage(png: Bytes, request?: { threshold?: number }): Promise<BitImage>;

/** Encodes ink as black on white; pixels with a nonzero `erased` become mid grey. */
export function encodeImage(image: {
  width: number; height: number; bits: Uint8Array | readonly number[]; erased?: Uint8Array;
}): Promise<Uint8Array>;

/** Version of the core, "major.minor.patch". */
export function version(): Promise<string>;

/** What the module may be loaded from. */
export type WasmSource = string | URL | Response | Bytes | WebAssembly.Module;

/**
 * Optional: loads the module ahead of the first call, or from another place than the package's own file.
 * Does nothing once it is loaded. Models with Draco compression need a larger build of the module; it is fetched with
 * the first of them, from dracoWasm if given.
 */
export function load(request?: {
  wasm?: WasmSource | Promise<WasmSource>; dracoWasm?: WasmSource | Promise<WasmSource>;
}): Promise<void>;

/** Frees the module's memory (wasm memory never shrinks otherwise); the next call loads it again. */
export function unload(): void;

/** Bytes of module memory held now; 0 when it is not loaded. */
export function memoryBytes(): number;
