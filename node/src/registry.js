// SPDX-License-Identifier: MIT
// The registry of who got which mark: JSON Lines, one object per marked copy (docs/format.md section 7).
import { isObject, toIdDigits, toText } from './arguments.js';
import { QuadmarkError } from './error.js';
import { toRecipient } from './recipients.js';

const VERSION = 1;

const isDigest = (value) => typeof value === 'string' && /^[0-9a-f]{64}$/.test(value);

/** Bits of a picture as base64, row by row, most significant bit first, as in reports. */
export function packImage({ width, height, bits }) {
  const packed = new Uint8Array(Math.ceil(bits.length / 8));
  bits.forEach((bit, i) => { packed[i >> 3] |= bit << (7 - (i & 7)); });
  return { width, height, bits: btoa(String.fromCharCode(...packed)) };
}

function unpackImage(what, image) {
  const { width, height, bits } = isObject(image) ? image : {};
  const count = width * height;
  let packed = null;
  try {
    packed = atob(bits);
  } catch { /* told below */ }
  if (!Number.isInteger(width) || !Number.isInteger(height) || width < 1 || height < 1 || packed?.length !== Math.ceil(count / 8)) {
    throw new QuadmarkError('bad_file', `${what}: image: expected { width, height, bits in base64 }`);
  }
  return { width, height, bits: Uint8Array.from({ length: count }, (_, i) => (packed.charCodeAt(i >> 3) >> (7 - (i & 7))) & 1) };
}

/** One line, with its end, of what embedding a copy for someone made. */
export function registryLine(entry) {
  const { recipient, id, image, salt, key, scheme, model, modelSha256, output, outputSha256, time } = entry;
  const record = {
    quadmarkRegistry: VERSION, recipient: toRecipient(recipient), ...(id === undefined ? { image: packImage(image) } : { id: toIdDigits(id) }),
    ...(salt ? { salt } : {}), key, scheme, model, modelSha256, output, outputSha256, time,
  };
  return `${JSON.stringify(record)}\n`;
}

function parseLine(line, what) {
  let record;
  try {
    record = JSON.parse(line);
  } catch (cause) {
    throw new QuadmarkError('bad_file', `${what}: not JSON`, { cause });
  }
  if (!isObject(record) || record.quadmarkRegistry === undefined) throw new QuadmarkError('bad_file', `${what}: not an entry of a registry`);
  if (record.quadmarkRegistry !== VERSION) {
    throw new QuadmarkError('unsupported_version', `${what}: registry format ${JSON.stringify(record.quadmarkRegistry)}, this version knows ${VERSION}`);
  }
  try {
    const { recipient, id, image, salt, ...rest } = record;
    if ((id === undefined) === (image === undefined)) throw new QuadmarkError('bad_file', 'expected either id or image');
    if (rest.modelSha256 !== undefined && !isDigest(rest.modelSha256)) throw new QuadmarkError('bad_file', 'modelSha256: expected 64 hexadecimal digits');
    return {
      ...rest, recipient: toRecipient(recipient), ...(id === undefined ? { image: unpackImage(what, image) } : { id: toIdDigits(id) }),
      ...(salt === undefined ? {} : { salt: toText('salt', salt) }),
    };
  } catch (error) {
    throw error.code === 'bad_option' ? new QuadmarkError('bad_file', `${what}: ${error.message}`, { cause: error }) : error;
  }
}

/**
 * Entries of a registry.
 * @param text  its content
 * @param name  of the file, for messages
 * @return { entries, end }  end: length of the complete lines; what is behind it is the torn line of a run that was killed
 */
export function parseRegistry(text, name = 'registry') {
  const entries = [];
  const end = text.lastIndexOf('\n') + 1;
  text.slice(0, end).split('\n').forEach((line, i) => {
    if (line.trim() !== '') entries.push(parseLine(line, `${name}, line ${i + 1}`));
  });
  return { entries, end };
}
