// SPDX-License-Identifier: MIT
// quadmark keygen: a key file around fresh random bytes.
import { DEFAULT_SCHEME } from '../api.js';
import { QuadmarkError } from '../error.js';
import { createKey, decodeImage } from '../index_node.js';
import { EXIT } from './exit.js';
import { readInput } from './files.js';
import { checkSettings } from './keys.js';
import { Writer } from './write.js';

async function payloadOf({ image, size, idBits }) {
  if ([image, size, idBits].filter((given) => given !== undefined).length !== 1) {
    throw new QuadmarkError('bad_option', 'give exactly one of --image, --size and --id-bits');
  }
  if (image !== undefined) {
    const { width, height } = await decodeImage(await readInput(image, 'cannot read the image'));
    return { width, height };
  }
  if (size !== undefined) return size;
  if (idBits !== 64) throw new QuadmarkError('bad_option', `--id-bits ${idBits}: only 64 is available`);
  return { id: true };
}

const PAPER_OPTIONS = {
  image: '--image', size: '--size', idBits: '--id-bits', firstDigit: '--first-digit', keyedCells: '--keyed-cells', set: '--set',
};

/**
 * The scheme that the options ask for: paper where one of them is about what only such keys hold, whatever the default.
 * @return { scheme, because }  because: the option that decided, if one did
 */
function schemeOf(options) {
  const [, because] = Object.entries(PAPER_OPTIONS).find(([member]) => options[member] !== undefined) ?? [];
  if (options.scheme === 'robust' && because) {
    throw new QuadmarkError('bad_option', `${because} does not go with --scheme robust, whose keys fit every payload`);
  }
  if (options.scheme !== undefined) return { scheme: options.scheme };
  return because ? { scheme: 'paper', because } : { scheme: DEFAULT_SCHEME };
}

function describe({ scheme, params }, payload) {
  if (scheme === 'robust') return 'IDs, texts and images, scheme robust';
  const what = payload.id ? 'a 64-bit ID' : `an image of ${params.width} x ${params.height} pixels`;
  return `${what}, scheme ${scheme}, digits ${params.L1}-${params.H1} and ${params.L2}-${params.H2}`;
}

export async function keygenCommand(path, options, output) {
  try {
    if (path === '-' && output.json) throw new QuadmarkError('bad_option', 'the key and --json both want standard output');
    const { scheme: wanted, because } = schemeOf(options);
    const payload = wanted === 'robust' ? {} : await payloadOf(options);
    const writer = new Writer(options, options.image === undefined ? [] : [options.image]);
    const target = writer.check(path, 'the key');
    const request = { owner: options.owner, scheme: wanted, ...payload, ...checkSettings(options.set, ['L']) };
    if (options.firstDigit !== undefined) request.L = options.firstDigit;
    if (options.keyedCells) request.keyedCells = true;
    const key = await createKey(request);
    // Whoever reads the key can read and forge marks: for the owner of the file alone.
    writer.writeAll([{ path: target, bytes: Buffer.from(`${JSON.stringify(key, null, 2)}\n`), mode: 0o600 }]);
    const { scheme, owner, params } = key;
    const warnings = because
      ? [`${because} makes this a key of scheme paper, whose marks do not survive quantization; without it the key is of scheme robust and fits every payload`]
      : [];
    for (const warning of warnings) output.log(warning);
    output.result(
      { output: path, scheme, owner, params, warnings },
      [`${path}: key for ${describe(key, payload)}`,
        'Keep it secret and keep a copy: the mark can be neither read nor proved without it.'],
      path === '-' ? process.stderr : process.stdout);
    return EXIT.done;
  } catch (error) {
    return output.failure(null, error);
  }
}
