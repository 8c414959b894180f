// SPDX-License-Identifier: MIT
// Options of the server, with their defaults.
import { availableParallelism, totalmem } from 'node:os';
import { QuadmarkError } from 'quadmark';

const MEBI = 2 ** 20;

/** Limits are explicit: nothing is unbounded unless asked for. Documented in index.d.ts. */
export const DEFAULTS = Object.freeze({
  host: '127.0.0.1',
  port: 8080,
  threads: availableParallelism(),
  queue: 4 * availableParallelism(),
  bodyLimit: 64 * MEBI,
  timeLimit: 60,
  maxRssBytes: Math.floor(0.75 * totalmem()),
  logger: true,
});

const RANGES = {
  port: [0, 65535], threads: [1, 256], queue: [0, 100000], bodyLimit: [1, 1024 * MEBI], timeLimit: [0.05, 86400],
  maxRssBytes: [0, Number.MAX_SAFE_INTEGER],
};
const FRACTIONS = ['timeLimit'];

/** `given` over the defaults; fails with `bad_option`. */
export function complete(given) {
  const options = { ...DEFAULTS };
  for (const [name, value] of Object.entries(given)) {
    if (value === undefined) continue;
    if (name !== 'keys' && !(name in DEFAULTS)) throw new QuadmarkError('bad_option', `options: unknown member ${JSON.stringify(name)}`);
    if (name in RANGES) {
      const [low, high] = RANGES[name];
      const whole = FRACTIONS.includes(name) || Number.isInteger(value);
      if (!(whole && value >= low && value <= high)) {
        throw new QuadmarkError('bad_option', `${name}: ${value} is not a number from ${low} to ${high}`);
      }
    }
    options[name] = value;
  }
  if (typeof options.keys !== 'string') throw new QuadmarkError('bad_option', 'keys: expected the directory that holds the keys, ID.json each');
  if (typeof options.host !== 'string') throw new QuadmarkError('bad_option', 'host: expected a name or an address');
  return options;
}
