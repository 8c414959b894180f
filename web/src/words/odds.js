// SPDX-License-Identifier: MIT
// Probabilities and verdicts in words. No DOM here: the words are tested alone.
import { shortWords, t, wholeWords } from './language.js';

/** A match needs this rare an accident: kMatchProbability of the core. */
const MATCH_ONE_IN = 1e6;

/** x cut down, never up, to `digits` significant digits: "at most 1 in N" must stay true. */
function floorTo(x, digits) {
  const unit = 10 ** (Math.floor(Math.log10(x)) - digits + 1);
  return unit >= 1 ? Math.floor(x / unit) * unit : Math.floor(x);
}

/**
 * A probability as "1 in N".
 * @return { text, exponent }: text "1 in 48,000", "1 in 2.3 billion", or "1 in 10" with the exponent of that ten;
 *         null when it is a half or more, which is no rarity at all
 */
export function oneIn(probability) {
  if (!(probability < 0.5)) return null;
  const n = 1 / probability;
  if (n >= 1e15) return { text: t('oneIn', '10'), exponent: Math.floor(Math.log10(n)) };
  for (const [size, name] of [[1e12, 'trillion'], [1e9, 'billion'], [1e6, 'million']]) {
    if (n >= size) {
      const count = floorTo(n, 2) / size;
      return { text: t('oneIn', t(name, { text: shortWords(count), one: count === 1 })), exponent: null };
    }
  }
  return { text: t('oneIn', wholeWords(floorTo(n, 3))), exponent: null };
}

/** The same for the ear: "1 in 10 to the power of 23". */
export function oneInSpoken(probability) {
  const odds = oneIn(probability);
  if (!odds) return t('noRarity').toLowerCase();
  return odds.exponent === null ? odds.text : t('toThePower', odds);
}

/** { label, title, meaning } of a result; meaning says what the probability means for it. */
export function verdictWords({ verdict, falsePositive }) {
  const rare = oneIn(falsePositive) !== null;
  const meaning = verdict === 'none' && !rare ? 'meaning_none_common' : `meaning_${verdict}`;
  return { label: t(`label_${verdict}`), title: t(`title_${verdict}`), meaning: t(meaning, wholeWords(MATCH_ONE_IN)) };
}
