// SPDX-License-Identifier: MIT
// The language of the page, and its texts by name. No DOM here.
import { MARK_TEXTS } from './texts_mark.js';
import { PAGE_TEXTS } from './texts_page.js';
import { PROBLEM_TEXTS } from './texts_problems.js';
import { VERIFY_TEXTS } from './texts_verify.js';

/** The one table: name -> [English, German], each a text or a function of what fills its gaps. */
export const TEXTS = { ...PAGE_TEXTS, ...VERIFY_TEXTS, ...PROBLEM_TEXTS, ...MARK_TEXTS };

export const LANGUAGES = ['en', 'de'];
let language = 'en';
let whole, short, fixed, precise;

/** Sets the language of all texts and numbers; another than LANGUAGES counts as English. */
export function setLanguage(name) {
  language = LANGUAGES.includes(name) ? name : 'en';
  const locale = language === 'de' ? 'de-DE' : 'en-US';
  whole = new Intl.NumberFormat(locale, { maximumFractionDigits: 0 });
  short = new Intl.NumberFormat(locale, { maximumSignificantDigits: 3 });
  fixed = new Intl.NumberFormat(locale, { minimumFractionDigits: 1, maximumFractionDigits: 1 });
  precise = new Intl.NumberFormat(locale, { minimumFractionDigits: 2, maximumFractionDigits: 2 });
}
setLanguage('en');

export const currentLanguage = () => language;

/** The text called `name`, its gaps filled from `values`. */
export function t(name, values) {
  const entry = TEXTS[name];
  if (!entry) throw new RangeError(`no text is called ${name}`);
  const text = entry[LANGUAGES.indexOf(language)];
  return typeof text === 'function' ? text(values) : text;
}

/** Whether there is a text of this name. */
export const hasText = (name) => Object.hasOwn(TEXTS, name);

export const wholeWords = (n) => whole.format(n);
export const shortWords = (x) => short.format(x);
export const tenthWords = (x) => fixed.format(x);
/** 1300 -> "1.30 s" */
export const secondsWords = (milliseconds) => `${precise.format(milliseconds / 1000)} s`;
/** 0.1234 -> "12.3 %" */
export const percent = (share) => `${short.format(share * 100)} %`;

/** 1.2e-7 -> "1.2 × 10⁻⁷" */
export function scientific(x) {
  if (x === 0) return '0';
  const [mantissa, exponent] = x.toExponential(1).split('e');
  const power = Number(exponent);
  if (power > -4 && power < 6) return short.format(x);
  const digits = String(power).replace(/./g, (c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]));
  return `${fixed.format(Number(mantissa))} × 10${digits}`;
}

/** "1.2 MB" */
export function sizeWords(bytes) {
  if (bytes < 1000) return t('bytes', bytes);
  const [size, unit] = [[1e9, 'GB'], [1e6, 'MB'], [1e3, 'kB']].find(([least]) => bytes >= least);
  return `${short.format(bytes / size)} ${unit}`;
}
