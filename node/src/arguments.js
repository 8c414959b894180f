// SPDX-License-Identifier: MIT
// Argument checks: JavaScript values to the few shapes the bindings take. Each failure names the argument.
import { QuadmarkError } from './error.js';

export const isObject = (value) => typeof value === 'object' && value !== null;

/** `object` itself after refusing members it should not have: a misspelt option must not be ignored. */
export function known(what, object, names) {
  if (!isObject(object) || Array.isArray(object)) throw new QuadmarkError('bad_option', `${what}: expected an object`);
  for (const name of Object.keys(object)) {
    if (!names.includes(name)) {
      throw new QuadmarkError('bad_option', `${what}: unknown member ${JSON.stringify(name)}, expected ${names.join(', ')}`);
    }
  }
  return object;
}

/** Uint8Array (Buffer included), any other view's bytes, or ArrayBuffer -> Uint8Array over the same memory. */
export function toBytes(what, value) {
  if (value instanceof Uint8Array) return value;
  if (value instanceof ArrayBuffer) return new Uint8Array(value);
  if (value instanceof DataView || value instanceof Uint8ClampedArray) {
    return new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
  }
  throw new QuadmarkError('bad_option', `${what}: expected a Uint8Array or ArrayBuffer`);
}

/** Map or plain object of URI -> bytes -> [[uri, Uint8Array], ...]. */
export function toEntries(resources) {
  if (resources == null) return [];
  if (!isObject(resources) || Array.isArray(resources) || ArrayBuffer.isView(resources)) {
    throw new QuadmarkError('bad_option', 'resources: expected an object or Map of URI to bytes');
  }
  const entries = resources instanceof Map ? [...resources] : Object.entries(resources);
  return entries.map(([uri, bytes]) => [String(uri), toBytes(`resources[${JSON.stringify(uri)}]`, bytes)]);
}

/** Key object, JSON text or bytes of it -> JSON text. */
export function toKeyJson(key) {
  if (typeof key === 'string') return key;
  if (key instanceof ArrayBuffer || ArrayBuffer.isView(key)) {
    try {
      return new TextDecoder('utf-8', { fatal: true }).decode(key);
    } catch (cause) {
      throw new QuadmarkError('bad_key', 'key: not UTF-8 text', { cause });
    }
  }
  if (!isObject(key)) throw new QuadmarkError('bad_key', 'key: expected a key object, its JSON text or its bytes');
  try {
    return JSON.stringify(key);
  } catch (cause) {
    throw new QuadmarkError('bad_key', `key: cannot be written as JSON (${cause.message})`, { cause });
  }
}

/** PNG bytes as they are; { width, height, bits } with bits as a Uint8Array. */
export function toImage(what, image) {
  if (image instanceof ArrayBuffer || ArrayBuffer.isView(image)) return toBytes(what, image);
  if (!isObject(image) || image.bits == null) {
    throw new QuadmarkError('bad_option', `${what}: expected PNG bytes or { width, height, bits }`);
  }
  const { width, height, bits } = image;
  return { width, height, bits: Array.isArray(bits) ? Uint8Array.from(bits) : toBytes(`${what}.bits`, bits) };
}

/** Well-formed text as it is. */
export function toText(what, text) {
  if (typeof text !== 'string' || /\p{Surrogate}/u.test(text)) {
    throw new QuadmarkError('bad_option', `${what}: expected well-formed text`);
  }
  return text;
}

/** Hexadecimal text of up to 16 digits, or a bigint below 2^64 -> 16 lower-case digits. */
export function toIdDigits(id, what = 'id') {
  const text = typeof id === 'bigint' && id >= 0n ? id.toString(16) : id;
  if (typeof text !== 'string' || !/^[0-9a-fA-F]{1,16}$/.test(text)) {
    throw new QuadmarkError('bad_option', `${what}: expected 1 to 16 hexadecimal digits or a bigint from 0 to 2^64 - 1`);
  }
  return text.toLowerCase().padStart(16, '0');
}
