// SPDX-License-Identifier: MIT
// Values on the command line: text to numbers, sizes and settings, refused with a sentence.
import { InvalidArgumentError } from 'commander';

export function parseNumber(text) {
  const number = Number(text);
  if (text.trim() === '' || !Number.isFinite(number)) throw new InvalidArgumentError('Not a number.');
  return number;
}

export function parseWhole(text) {
  const number = parseNumber(text);
  if (!Number.isSafeInteger(number) || number < 0) throw new InvalidArgumentError('Not a whole number from 0.');
  return number;
}

export function parseSize(text) {
  const match = /^(\d{1,5})x(\d{1,5})$/i.exec(text);
  if (!match) throw new InvalidArgumentError('Expected WIDTHxHEIGHT, for example 24x24.');
  return { width: Number(match[1]), height: Number(match[2]) };
}

export function collectSetting(text, settings = {}) {
  const match = /^([A-Za-z][A-Za-z0-9]*)=(.+)$/.exec(text);
  if (!match) throw new InvalidArgumentError('Expected NAME=VALUE.');
  const [, name, value] = match;
  const parsed = value === 'true' ? true : value === 'false' ? false : parseNumber(value);
  return { ...settings, [name]: parsed };
}
