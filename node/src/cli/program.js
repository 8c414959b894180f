// SPDX-License-Identifier: MIT
// The command line's grammar. What each command does is in its own file, over the library's public calls.
import { Command, CommanderError, InvalidArgumentError, Option } from 'commander';
import { readFileSync } from 'node:fs';
import { DEFAULT_SCHEME } from '../api.js';
import { attackCommand } from './attack.js';
import { embedCommand } from './embed.js';
import { EXIT } from './exit.js';
import { extractCommand } from './extract.js';
import { inspectCommand } from './inspect.js';
import { keygenCommand } from './keygen.js';
import { Output } from './output.js';

const { version } = JSON.parse(readFileSync(new URL('../../package.json', import.meta.url), 'utf8'));

function parseNumber(text) {
  const number = Number(text);
  if (text.trim() === '' || !Number.isFinite(number)) throw new InvalidArgumentError('Not a number.');
  return number;
}

function parseWhole(text) {
  const number = parseNumber(text);
  if (!Number.isSafeInteger(number) || number < 0) throw new InvalidArgumentError('Not a whole number from 0.');
  return number;
}

function parseSize(text) {
  const match = /^(\d{1,5})x(\d{1,5})$/i.exec(text);
  if (!match) throw new InvalidArgumentError('Expected WIDTHxHEIGHT, for example 24x24.');
  return { width: Number(match[1]), height: Number(match[2]) };
}

function collectSetting(text, settings = {}) {
  const match = /^([A-Za-z][A-Za-z0-9]*)=(.+)$/.exec(text);
  if (!match) throw new InvalidArgumentError('Expected NAME=VALUE.');
  const [, name, value] = match;
  const parsed = value === 'true' ? true : value === 'false' ? false : parseNumber(value);
  return { ...settings, [name]: parsed };
}

const EXIT_HELP = `
Exit status: 0 done or mark found, 1 failure, 2 usage, 3 no mark, 4 inconclusive.
The name - stands for standard input or output. Logs go to standard error.`;

/**
 * Runs one command line.
 * @param argv  arguments after the program's name
 * @return the exit status
 */
export async function run(argv) {
  let status = EXIT.done;
  const program = new Command('quadmark')
    .description('Invisible, keyed watermarks in the vertex positions of 3D models (glTF, GLB, PLY).')
    .version(version)
    .exitOverride()
    .configureHelp({ helpWidth: 100 })
    .addHelpText('after', EXIT_HELP);

  const define = (name, description, command) => {
    const defined = program.command(name).description(description)
      .option('--json', 'print exactly one JSON object per input on standard output')
      .option('--quiet', 'print nothing but errors and, with --json, the JSON')
      .exitOverride()
      .configureHelp({ helpWidth: 100 });
    defined.action(async (...args) => {
      const options = args.at(-2);
      const positional = args.slice(0, -2);
      status = await command(...positional, options, new Output(name, options));
    });
    return defined;
  };
  const keyOption = () =>
    new Option('--key <file>', 'key file; secrets never go on the command line itself').env('QUADMARK_KEY_FILE');
  const setOption = (what) => new Option('--set <name=value>', what).argParser(collectSetting);
  const jobs = ['--jobs <count>', 'handle this many inputs at once; 0 takes one per processor', parseWhole, 1];
  const force = ['--force', 'overwrite existing files'];

  define('keygen', 'make a key file', keygenCommand)
    .argument('<key.json>', 'where to write the key')
    .option('--owner <text>', 'who the mark is for; kept in the key file', '')
    .option('--scheme <scheme>', `watermarking scheme: robust or paper (default: ${DEFAULT_SCHEME}; paper with any option below)`)
    .option('--image <logo.png>', 'make the key for images of this one\'s size')
    .option('--size <WxH>', 'make the key for images of this size in pixels', parseSize)
    .option('--id-bits <bits>', 'make the key for IDs of this length; only 64', parseWhole)
    .option('-L, --first-digit <position>', 'first decimal digit that carries data: 2 suits scans, 3 CAD models', parseWhole)
    .option('--keyed-cells', 'let the key pick the places that carry data')
    .addOption(setOption('parameter of the scheme: H1, L1, H2, L2, lambda, tau, k, ... (repeatable)'))
    .option(...force);

  define('embed', 'mark models', embedCommand)
    .argument('<files...>', 'IN OUT, or many inputs and globs with --out-dir')
    .addOption(keyOption())
    .option('--image <logo.png>', 'picture to embed; with scheme paper of the key\'s size')
    .option('--id <hex>', '64-bit ID to embed, 1 to 16 hexadecimal digits')
    .option('--text <text>', 'text to embed, up to 64 bytes (scheme robust, like the next five)')
    .option('--strength <preset>', 'invisible, standard or strong')
    .option('--max-error <share>', 'largest displacement, fraction of the diagonal', parseNumber)
    .option('--max-slide <share>', 'largest displacement along the surface, fraction of the diagonal', parseNumber)
    .option('--salt <text>', 'name of the asset; extract takes the same one')
    .option('--self-test', 'damage the marked model in six ways and report which it withstands')
    .option('--scheme <scheme>', 'fail unless the key is for this scheme')
    .option('--out-dir <dir>', 'write each marked model here under its own name')
    .option(...jobs)
    .addOption(setOption('parameter of the key to override, for reading too (repeatable)'))
    .option(...force);

  define('extract', 'read the mark of models', extractCommand)
    .argument('<files...>', 'models or globs')
    .addOption(keyOption())
    .option('--reference <logo.png>', 'compare with this picture')
    .option('--expect-id <hex>', 'is it this ID? (scheme robust, like the next two)')
    .option('--expect-text <text>', 'is it this text?')
    .option('--salt <text>', 'name of the asset, as given to embed')
    .option('--image-out <mark.png>', 'write the picture that was read')
    .option('--confidence-out <map.png>', 'write how certain each pixel is')
    .option('--out-dir <dir>', 'write both pictures of each model here as NAME.mark.png and NAME.confidence.png')
    .option(...jobs)
    .addOption(setOption('parameter of the key to override (repeatable)'))
    .option(...force);

  define('inspect', 'describe models without a key', inspectCommand)
    .argument('<files...>', 'models or globs')
    .option(...jobs);

  define('attack', 'damage a model on purpose, to see what a mark withstands', attackCommand)
    .argument('<in>', 'model')
    .argument('<out>', 'new PLY or GLB file')
    .requiredOption('--kind <kind>', 'what to do')
    .option('--amount <number>', 'how much; the meaning depends on the kind', parseNumber)
    .option('--variant <name>', 'which form of the kind')
    .option('--iterations <count>', 'how often (smooth)', parseWhole)
    .option('--seed <number>', 'of the random numbers', parseWhole, 1)
    .option('--format <format>', 'ply or glb; default: by the name of OUT, else ply')
    .option(...force)
    .addHelpText('after', `
Kinds:
  affine       --variant R | NS | RE | S | SH | CB
  reorder      vertices, faces and corners in another order
  crop         --amount SHARE of the vertices removed, 0 to 1
  noise        --amount AMPLITUDE, fraction of the bounding-box diagonal
  local-noise  the same on one side of the model
  quantize     --amount BITS --variant common | per-axis
  smooth       --amount LAMBDA --variant taubin | laplacian --iterations N
  simplify     --amount SHARE removed, 0 to 1 --variant meshopt | qem
  deform       --amount RADIANS of bend and twist`);

  try {
    await program.parseAsync(argv, { from: 'user' });
    return status;
  } catch (error) {
    if (error instanceof CommanderError) return error.exitCode === 0 ? EXIT.done : EXIT.usage;
    throw error;
  }
}
