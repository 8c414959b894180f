// SPDX-License-Identifier: MIT
// Entry `quadmark/gltf-transform/config`: adds the command `mark` to glTF-Transform's own command line, by --config.
import { readFile } from 'node:fs/promises';
import { QuadmarkError } from '../error.js';
import { quadmark } from './index.js';

async function read(path, what) {
  try {
    return await readFile(path);
  } catch (cause) {
    throw new QuadmarkError('io', `cannot read the ${what} ${path}: ${cause.message}`, { cause });
  }
}

const numberOf = (name, text) => {
  if (text === undefined) return undefined;
  const value = Number(text);
  if (!Number.isFinite(value)) throw new QuadmarkError('bad_option', `--${name} ${text}: not a number`);
  return value;
};

// Its parser would turn an ID like 1e5 into a number: Validator.STRING of @gltf-transform/cli.
const TEXT = { validator: 4 };

async function optionsOf({ key = process.env.QUADMARK_KEY_FILE, image, id, text, strength, salt, maxError, maxSlide }) {
  if (!key) throw new QuadmarkError('bad_option', 'no key: give --key FILE or set QUADMARK_KEY_FILE');
  const options = {
    key: await read(key, 'key'), id, text, strength, salt,
    maxError: numberOf('max-error', maxError), maxSlide: numberOf('max-slide', maxSlide),
    image: image === undefined ? undefined : await read(image, 'image'),
  };
  return Object.fromEntries(Object.entries(options).filter(([, value]) => value !== undefined));
}

export default {
  /** Called by @gltf-transform/cli with its program, its io and the class of a session. */
  async onProgramReady({ program, io, Session }) {
    // Its parser knows --config behind the command alone; who wrote it in front has it moved before the line is parsed.
    if (process.argv[2] === '--config') process.argv.push(...process.argv.splice(2, 2));
    program
      .command('mark', 'Embed an invisible watermark in vertex positions (quadmark)')
      .help('Marks the model by a key made with `quadmark keygen`. Run it last: compression afterwards takes from the mark.')
      .argument('<input>', 'Path to read glTF 2.0 (.glb, .gltf) model')
      .argument('<output>', 'Path to write output')
      .option('--key <file>', 'Key file (default: QUADMARK_KEY_FILE)', TEXT)
      .option('--id <hex>', '64-bit ID to embed, 1 to 16 hexadecimal digits', TEXT)
      .option('--image <file>', 'Picture to embed (PNG)', TEXT)
      .option('--text <text>', 'Text to embed, up to 64 bytes', TEXT)
      .option('--strength <preset>', 'invisible, standard (default) or strong', TEXT)
      .option('--max-error <share>', 'Largest displacement, fraction of the diagonal')
      .option('--max-slide <share>', 'Largest displacement along the surface, fraction of the diagonal')
      .option('--salt <text>', 'Name of the asset; reading takes the same one', TEXT)
      .action(async ({ args, options, logger }) => {
        await Session.create(io, logger, args.input, args.output).transform(quadmark(await optionsOf(options)));
      });
  },
};
