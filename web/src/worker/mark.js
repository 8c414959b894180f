// SPDX-License-Identifier: MIT
// The jobs of the tab that marks.
import { embed, inspect, load, version } from 'quadmark';
import { baseName } from '../files/paths.js';
import { attempt, openModel } from './files.js';
import { fingerprint } from './hash.js';
import { openKey } from './keys.js';

/** { model: Item, parts: Item[] } -> { report: of inspect() } */
export async function inspectModel({ model, parts }, progress) {
  progress('load', 0);
  await attempt('page', load());
  progress('read', 0.2);
  const { bytes, resources } = await openModel(model, parts);
  return { answer: { type: 'result', report: await attempt('model', inspect(bytes, { resources })) } };
}

/**
 * @param request  { model: Item, parts: Item[], key: as openKey takes it, payload: { image } | { id } | { text }, strength, salt }
 * @return { bytes, resources: [{ name, bytes }] that changed, key: text of the key file, report, inputs, outputs, toolVersion, millis }
 */
export async function mark({ model, parts, key, payload, strength, salt }, progress) {
  progress('load', 0);
  await attempt('page', load());
  progress('open', 0.05);
  const { key: keyObject, told } = await openKey(key);
  const { bytes, resources, named } = await openModel(model, parts);
  const started = performance.now();
  const options = { onProgress: ({ stage, done }) => progress(stage, 0.1 + 0.85 * done) };
  if (keyObject.scheme === 'robust') options.strength = strength;
  if (salt) options.salt = salt;
  const about = payload.image ? 'logo' : 'model';
  const result = await attempt('model', embed(bytes, { key: keyObject, ...payload, resources, options }), { picture: about });
  const millis = Math.round(performance.now() - started);
  progress('hash', 0.95);
  const changed = Object.entries(result.resources).map(([uri, content]) => ({ name: baseName(decodeURIComponent(uri)), bytes: content }));
  const printsOf = (files) => Promise.all(files.map(({ name, bytes: content }) => fingerprint(name, content)));
  const answer = {
    type: 'result',
    bytes: result.bytes,
    resources: changed,
    key: `${JSON.stringify(keyObject, null, 2)}\n`,
    report: result.report,
    inputs: { model: await fingerprint(baseName(model.path), bytes), resources: await printsOf(named), key: told, reference: null },
    outputs: { model: await fingerprint(baseName(model.path), result.bytes), resources: await printsOf(changed) },
    toolVersion: await version(),
    millis,
  };
  return { answer, transfer: [result.bytes.buffer, ...changed.map(({ bytes: content }) => content.buffer)] };
}
