// SPDX-License-Identifier: MIT
// The job of the tab that verifies.
import { decodeImage, encodeImage, extract, load, version } from 'quadmark';
import { baseName } from '../files/paths.js';
import { attempt, openModel, readFile } from './files.js';
import { fingerprint } from './hash.js';
import { openKey } from './keys.js';

/**
 * @param request  { model: Item, parts: Item[], key: as openKey takes it, reference: File | null, salt: text, possibly empty }
 * @return the result: what extract() returns, and { reference, salt, inputs (for the report), toolVersion, isId, averageConfidence, millis }
 */
export async function verify({ model, parts, key, reference, salt }, progress) {
  progress('load', 0);
  await attempt('page', load());
  progress('open', 0.05);
  const { key: keyObject, told } = await openKey(key);
  const referenceBytes = reference ? await readFile('reference', reference) : null;
  const expected = reference ? await attempt('reference', decodeImage(referenceBytes)) : null;
  const { bytes, resources, named } = await openModel(model, parts);

  const started = performance.now();
  const result = await attempt('model', extract(bytes, {
    key: keyObject,
    reference: expected ?? undefined,
    resources,
    options: { ...(salt && { salt }), onProgress: ({ stage, done }) => progress(stage, 0.1 + 0.85 * done) },
  }));
  const millis = Math.round(performance.now() - started);
  progress('hash', 0.95);
  const inputs = {
    model: await fingerprint(baseName(model.path), bytes),
    resources: await Promise.all(named.map(({ name, bytes: content }) => fingerprint(name, content))),
    key: told,
    reference: reference ? await fingerprint(reference.name, referenceBytes) : null,
  };
  const { image, evidence } = result;
  let average = 0;
  for (const value of image?.confidence ?? []) average += value / image.confidence.length;
  const answer = {
    type: 'result',
    ...result,
    millis,
    inputs,
    salt,
    toolVersion: await version(),
    isId: image === null || keyObject.params?.payload === 'id',
    averageConfidence: average,
    reference: expected && { ...expected, png: await encodeImage(expected) },
  };
  return { answer, transfer: [evidence.buffer] };
}
