// SPDX-License-Identifier: MIT
// Reports as JSON: what was read, with what, when, and what came out. Their shape is schema.json, version 1.

export const REPORT_VERSION = 1;

const CAVEAT = 'A match says that the model carries the mark of this key. It does not say who marked it first, or who owns it.';

const frame = (kind, { toolVersion, inputs }, made) => ({
  quadmarkReport: REPORT_VERSION,
  kind,
  made: made.toISOString(),
  tool: { name: 'quadmark', version: toolVersion },
  inputs,
});

/** @param result  of the job "verify"; @param made  a Date */
export function verificationRecord(result, made) {
  const { verdict, falsePositive, report, millis } = result;
  return {
    ...frame('verification', result, made),
    parameters: { scheme: report.scheme, salt: result.salt, reference: result.reference !== null },
    verdict,
    falsePositive,
    caveat: CAVEAT,
    millis,
    numbers: report,
  };
}

/** @param result  of the job "mark"; payload: { image } | { id } | { text } */
export function markingRecord(result, { payload, strength, salt }, made) {
  const { report, outputs, millis } = result;
  const told = payload.image ? { image: { width: payload.image.width, height: payload.image.height } } : payload;
  return {
    ...frame('marking', result, made),
    outputs,
    parameters: { scheme: report.scheme, salt, strength, payload: told },
    caveat: CAVEAT,
    millis,
    numbers: report,
  };
}
