// SPDX-License-Identifier: MIT
// What makes two jobs the same: equal bytes in, key, payload, options and version give equal bytes out, so a job with an
// id that exists need not be done again. The output's name belongs to it: equal models under two names are two outputs.
import { createHash } from 'node:crypto';
import { keyFingerprint, parseKey } from 'quadmark';

export const sha256 = (bytes) => createHash('sha256').update(bytes).digest('hex');

const byName = ([a], [b]) => (a < b ? -1 : 1);
const isPlain = (value) => typeof value === 'object' && value !== null && !Array.isArray(value);

/** JSON with members in one order, whatever order they were given in. */
const canonical = (value) =>
  JSON.stringify(value, (name, item) => (isPlain(item) ? Object.fromEntries(Object.entries(item).sort(byName)) : item));

/** Of a key, for finding it among a worker's keys: its members, with the product's fingerprint for the secret. */
export async function fingerprint(key) {
  const parsed = await parseKey(key);
  return sha256(canonical({ ...parsed, secret: await keyFingerprint(parsed) })).slice(0, 32);
}

/** Of a model and its buffers: [model, [uri, buffer], ...] as hashes. */
export const contentHash = ({ bytes, resources }) => {
  const buffers = Object.entries(resources).sort(byName).map(([uri, buffer]) => [uri, sha256(buffer)]);
  return sha256(canonical([sha256(bytes), ...buffers]));
};

/** @param work  { version, content, key, mark, options, output } */
export const jobIdOf = (work) => `m${sha256(canonical(work)).slice(0, 40)}`;

/** Of a run: the same jobs and the same report are the same run. */
export const runIdOf = (jobIds, report) => `r${sha256(canonical([[...jobIds].sort(), report])).slice(0, 40)}`;
