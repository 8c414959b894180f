// SPDX-License-Identifier: MIT
// One mark per recipient: the ID of each follows from the key and the name, and a leaked copy is traced by reading its ID,
// or, where that is too faint, by asking for each candidate's. Documented in index.d.ts and docs/format.md section 7.
import { isObject, known, toBytes, toIdDigits, toImage, toText } from './arguments.js';
import { QuadmarkError } from './error.js';

/** Naming someone takes as much certainty as a match does: core/include/quadmark/verdict.h. */
const MATCH_PROBABILITY = 1e-6;
const DOUBT_PROBABILITY = 1e-4;

const MAX_NAME_BYTES = 256;

/** 64 bits of HKDF-SHA256 (salt empty) as 16 hexadecimal digits. */
async function derive(secret, info) {
  const subtle = globalThis.crypto?.subtle;
  if (!subtle) throw new QuadmarkError('io', 'WebCrypto is not available: browsers offer it to pages served over https alone');
  const ikm = Uint8Array.from(atob(secret), (character) => character.charCodeAt(0));
  const base = await subtle.importKey('raw', ikm, 'HKDF', false, ['deriveBits']);
  const bits = await subtle.deriveBits({ name: 'HKDF', hash: 'SHA-256', salt: new Uint8Array(), info: new TextEncoder().encode(info) }, base, 64);
  return Array.from(new Uint8Array(bits), (byte) => byte.toString(16).padStart(2, '0')).join('');
}

/** A recipient's name in its one form: trimmed, NFC. */
export function toRecipient(name, what = 'recipient') {
  const text = toText(what, name).trim().normalize('NFC');
  if (text === '') throw new QuadmarkError('bad_option', `${what}: empty`);
  if (/\p{Cc}/u.test(text)) throw new QuadmarkError('bad_option', `${what} ${JSON.stringify(text)}: control characters`);
  const size = new TextEncoder().encode(text).length;
  if (size > MAX_NAME_BYTES) throw new QuadmarkError('bad_option', `${what}: ${size} bytes, at most ${MAX_NAME_BYTES}`);
  return text;
}

/** ln of the probability that `n` fair coins agree at least `k` times. */
function logTail(n, k) {
  let logChoose = 0, tail = -Infinity;  // of i = n, downwards
  for (let i = n; i >= k; --i) {
    if (i < n) logChoose += Math.log(i + 1) - Math.log(n - i);
    const term = logChoose - n * Math.LN2, high = Math.max(tail, term);
    tail = high + Math.log(Math.exp(tail - high) + Math.exp(term - high));
  }
  return Math.min(0, tail);
}

/** Pixels of a candidate's picture; an ID is 64 of them to scheme paper. */
const bitsOf = ({ id, image }) => image?.bits ?? Uint8Array.from(BigInt(`0x${id}`).toString(2).padStart(64, '0'), Number);

const samePixels = (a, b) => a.width === b.width && a.height === b.height && a.bits.every((bit, i) => bit === b.bits[i]);

/**
 * Probability of reading at least this much of `candidate` from a copy with the mark of any of `others`, or of a random
 * one: the most likely of them, each counted where the two differ and a bit was read.
 */
function pixelProbability(read, candidate, others) {
  const counted = (differs) => {
    let n = 0, agreed = 0;
    for (let i = 0; i < read.bits.length; ++i) {
      if (read.erased[i] || !differs(i)) continue;
      ++n;
      if (read.bits[i] === candidate[i]) ++agreed;
    }
    return Math.exp(logTail(n, agreed));
  };
  return Math.max(counted(() => true), ...others.map((other) => counted((i) => other[i] !== candidate[i])));
}

function toCandidate(value, index) {
  const what = `candidates[${index}]`;
  if (!isObject(value)) throw new QuadmarkError('bad_option', `${what}: expected an object`);
  const { recipient, id, image, salt } = value;
  const candidate = { recipient: toRecipient(recipient, `${what}.recipient`), salt: salt == null ? '' : toText(`${what}.salt`, salt) };
  if ((id == null) === (image == null)) throw new QuadmarkError('bad_option', `${what}: give either id or image`);
  if (id != null) candidate.id = toIdDigits(id, `${what}.id`);
  else candidate.image = toImage(`${what}.image`, image);
  return candidate;
}

const identityOf = ({ recipient, id, image, salt }) => JSON.stringify([recipient, id ?? `${image.width}x${image.height}:${image.bits.join('')}`, salt]);

/** Each candidate once, in order; a mark that two recipients share cannot tell them apart and is refused. */
function distinct(candidates) {
  const seen = new Map(), owners = new Map();
  for (const candidate of candidates) {
    const mark = identityOf({ ...candidate, recipient: '' });
    const owner = owners.get(mark);
    if (owner !== undefined && owner !== candidate.recipient) {
      throw new QuadmarkError('bad_option', `candidates: ${JSON.stringify(owner)} and ${JSON.stringify(candidate.recipient)} have the same mark`);
    }
    owners.set(mark, candidate.recipient);
    seen.set(identityOf(candidate), candidate);
  }
  return [...seen.values()];
}

/**
 * Binds the calls to those of the library.
 * @param api    { extract, parseKey, decodeImage } as createApi() makes them
 * @param lanes  how many calls of extract may run at once
 */
export function createRecipients({ extract, parseKey, decodeImage }, lanes = 1) {
  async function inLanes(items, handle) {
    const results = [];
    let next = 0;
    const lane = async () => {
      while (next < items.length) {
        const index = next++;
        results[index] = await handle(items[index]);
      }
    };
    await Promise.all(Array.from({ length: lanes }, lane));
    return results;
  }

  async function withPixels(candidate) {
    if (!(candidate.image instanceof Uint8Array)) return candidate;
    return { ...candidate, image: await decodeImage(candidate.image) };
  }

  /**
   * [{ candidate, falsePositive, corrected }]: what a blind reading says about the candidates of its salt.
   * @param trials  how many candidates there are in all; every comparison with one is one more chance to be wrong
   * @param salts   how many blind readings there are
   */
  async function judge(read, candidates, { trials, salts }, compare) {
    // The bound of a blind reading holds for all 2^64 IDs (or pictures) at once, so it holds for those of the list.
    const presence = read.falsePositive * salts;
    const readAs = (same) => candidates.filter(same)
      .map((candidate) => ({ candidate, falsePositive: read.falsePositive, corrected: presence }));
    if (read.report.scheme !== 'paper') {
      if (read.id !== null) return readAs(({ id }) => id === read.id);
      if (read.text !== null) return [];
      if (read.report.exact === true) return readAs(({ image }) => image !== undefined && samePixels(image, read.image));
      if (read.image === null) {
        return (await compare(candidates)).map((one) => ({ ...one, corrected: one.falsePositive * trials }));
      }
    }
    if (read.verdict === 'none') return [];
    const bits = candidates.map(bitsOf);
    return candidates.flatMap((candidate, i) => {
      if (bits[i]?.length !== read.image.bits.length) return [];
      const others = bits.filter((other, j) => j !== i && other?.length === bits[i].length);
      const pixels = pixelProbability(read.image, bits[i], others);
      return [{ candidate, falsePositive: Math.max(read.falsePositive, pixels), corrected: Math.max(presence, pixels * trials) }];
    });
  }

  return {
    async recipientId(key, recipient) {
      return derive((await parseKey(key)).secret, `quadmark/recipient/v1\0${toRecipient(recipient)}`);
    },

    async keyFingerprint(key) {
      return derive((await parseKey(key)).secret, 'quadmark/fingerprint/v1');
    },

    async trace(model, request) {
      const { key: given, candidates: list, resources, options = {} } = known('request', request, ['key', 'candidates', 'resources', 'options']);
      const { onProgress, onCandidate, signal } = known('options', options, ['onProgress', 'onCandidate', 'signal']);
      if (typeof list?.[Symbol.iterator] !== 'function') throw new QuadmarkError('bad_option', 'candidates: expected a list');
      const bytes = toBytes('model', model);
      const key = await parseKey(given);
      const candidates = distinct(await Promise.all([...list].map(toCandidate).map(withPixels)));
      if (candidates.length === 0) throw new QuadmarkError('bad_option', 'candidates: nobody is in the list');
      const salts = [...new Set(candidates.map(({ salt }) => salt))];
      if (key.scheme === 'paper' && salts.some((salt) => salt !== '')) throw new QuadmarkError('bad_option', 'candidates: a salt does not go with a key of scheme paper');
      const trials = candidates.length;
      const call = (salt, expected) => extract(bytes, {
        key, resources, ...expected, options: { onProgress, signal, ...(salt === '' ? {} : { salt }) },
      });

      const found = [], read = [];
      let compared = 0, doubtful = false;
      for (const salt of salts) {
        const blind = await call(salt, {});
        const ofSalt = candidates.filter((candidate) => candidate.salt === salt);
        if (blind.id !== null && blind.verdict === 'match') read.push(blind.id);
        doubtful ||= blind.verdict === 'inconclusive';
        found.push(...await judge(blind, ofSalt, { trials, salts: salts.length }, (asked) => inLanes(asked, async (candidate) => {
          const { id, image } = candidate;
          const { report: { expected } } = await call(salt, id === undefined ? { reference: image } : { expectId: id });
          ++compared;
          onCandidate?.({ done: compared, candidates: trials });
          return { candidate, falsePositive: expected.comparison === 'differs' ? 1 : expected.falsePositive };
        })));
      }
      const ranked = found
        .map(({ candidate: { recipient, id = null, salt }, falsePositive, corrected }) =>
          ({ recipient, id, salt, falsePositive, corrected: Math.min(1, corrected) }))
        .sort((a, b) => a.corrected - b.corrected)
        .filter(({ corrected }, i) => i === 0 || corrected <= DOUBT_PROBABILITY);
      const [best] = ranked;
      const named = best !== undefined && best.corrected <= MATCH_PROBABILITY;
      const inDoubt = best !== undefined && best.corrected <= DOUBT_PROBABILITY;
      return {
        verdict: named ? 'match' : inDoubt || (doubtful && read.length === 0) ? 'inconclusive' : 'none',
        recipient: named ? best.recipient : null,
        id: named ? best.id : read[0] ?? null,
        falsePositive: best?.corrected ?? 1,
        method: compared > 0 ? 'compared' : 'read',
        trials,
        candidates: inDoubt ? ranked : [],
      };
    },
  };
}
