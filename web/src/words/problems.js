// SPDX-License-Identifier: MIT
// Failures as sentences. The core's own sentence names the place and stays English in every language.
import { hasText, t } from './language.js';

/** A message of the API as a sentence: capital letter, full stop. */
export function sentence(message) {
  const text = message.trim();
  const start = /^[a-z]+ /.test(text) ? text[0].toUpperCase() + text.slice(1) : text;
  return /[.!?]$/.test(start) ? start : `${start}.`;
}

/** { title, text, hint } of a failure; names: file name by "model", "key", "reference" and "logo". */
export function problemWords({ about, code, message }, names) {
  const known = hasText(`problem_${about}_${code}`);
  const what = t(known ? `problem_${about}_${code}` : 'problem_other');
  const subject = about === 'page' ? t('thePage') : names[about];
  return { title: `${subject} ${what}.`, text: sentence(message), hint: known ? t(`hint_${about}_${code}`) : '' };
}

/** { title, text, hint } when external buffers of a glTF were not given. */
export function missingWords(uris, modelName) {
  const rest = uris.length - 5;
  const list = uris.slice(0, 5).join(', ') + (rest > 0 ? t('andMore', rest) : '');
  const one = uris.length === 1;
  return { title: t('missingTitle', uris.length), text: t('missingText', { modelName, list, one }), hint: t('missingHint', one) };
}
