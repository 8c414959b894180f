// SPDX-License-Identifier: MIT
// The command line's grammar. What each command does is in its own file, over the library's public calls.
import { Command, CommanderError, Option } from 'commander';
import { readFileSync } from 'node:fs';
import { DEFAULT_SCHEME } from '../api.js';
import { attackCommand } from './attack.js';
import { completionScript, SHELLS } from './completion.js';
import { embedCommand } from './embed.js';
import { EXIT } from './exit.js';
import { extractCommand } from './extract.js';
import { inspectCommand } from './inspect.js';
import { keygenCommand } from './keygen.js';
import { manualPage } from './manual.js';
import { Output } from './output.js';
import { defineServe } from './serve.js';
import { traceCommand } from './trace.js';
import { collectSetting, parseNumber, parseSize, parseWhole } from './values.js';

const { version } = JSON.parse(readFileSync(new URL('../../package.json', import.meta.url), 'utf8'));

const EXIT_HELP = `
Exit status: 0 done or mark found, 1 failure, 2 usage, 3 no mark, 4 inconclusive.
The name - stands for standard input or output. Logs go to standard error.
Environment: QUADMARK_KEY_FILE (the key file where --key is not given), NO_COLOR (no colours).`;

const STRENGTHS = ['invisible', 'standard', 'strong'];

const ATTACKS = {
  'affine': '--variant R | NS | RE | S | SH | CB',
  'reorder': 'vertices, faces and corners in another order',
  'crop': '--amount SHARE of the vertices removed, 0 to 1',
  'noise': '--amount AMPLITUDE, fraction of the bounding-box diagonal',
  'local-noise': 'the same on one side of the model',
  'quantize': '--amount BITS --variant common | per-axis',
  'smooth': '--amount LAMBDA --variant taubin | laplacian --iterations N',
  'simplify': '--amount SHARE removed, 0 to 1 --variant meshopt | qem',
  'deform': '--amount RADIANS of bend and twist',
};

/**
 * The whole grammar.
 * @param finish  called with the exit status of the command that ran
 */
export function createProgram(finish = () => {}) {
  const program = new Command('quadmark')
    .description('Invisible, keyed watermarks in the vertex positions of 3D models (glTF, GLB, PLY).')
    .version(version)
    .exitOverride()
    .configureHelp({ helpWidth: 100 })
    .addHelpText('after', EXIT_HELP);

  const define = (name, description, command) => {
    const defined = program.command(name).description(description)
      .option('--json', 'print exactly one JSON object per input on standard output (default: sentences)')
      .option('--quiet', 'print nothing but errors and, with --json, the JSON (default: off)')
      .exitOverride()
      .configureHelp({ helpWidth: 100 });
    return defined.action(async (...args) => {
      const options = args.at(-2);
      const positional = args.slice(0, -2);
      finish(await command(...positional, options, new Output(name, options)));
    });
  };
  const keyOption = () =>
    new Option('--key <file>', 'key file, needed; secrets never go on the command line itself').env('QUADMARK_KEY_FILE');
  const setOption = (what) => new Option('--set <name=value>', what).argParser(collectSetting);
  const schemeOption = (what) => new Option('--scheme <scheme>', what).choices(['robust', 'paper']);
  const jobs = ['--jobs <count>', 'handle this many inputs at once, in threads; 0 takes one per processor', parseWhole, 1];
  const force = ['--force', 'overwrite existing files, never an input (default: refuse)'];
  const dryRun = ['--dry-run', 'do all the work and checks, write nothing (default: off)'];

  define('keygen', 'make a key file', keygenCommand)
    .argument('<key.json>', 'where to write the key')
    .option('--owner <text>', 'who the mark is for; kept in the key file', '')
    .addOption(schemeOption(`watermarking scheme (default: ${DEFAULT_SCHEME}; paper with any option below)`))
    .option('--image <logo.png>', 'make the key for images of this one\'s size (default: none)')
    .option('--size <WxH>', 'make the key for images of this size in pixels (default: none)', parseSize)
    .option('--id-bits <bits>', 'make the key for IDs of this length; only 64 (default: none)', parseWhole)
    .option('-L, --first-digit <position>', 'first decimal digit that carries data: 2 suits scans, 3 CAD models (default: 2)', parseWhole)
    .option('--keyed-cells', 'let the key pick the places that carry data (default: all do)')
    .addOption(setOption('parameter of the scheme: H1, L1, H2, L2, lambda, tau, k, ... (repeatable; default: the scheme\'s own)'))
    .option(...dryRun)
    .option(...force);

  define('embed', 'mark models', embedCommand)
    .argument('<files...>', 'IN OUT, or many inputs and globs with --out-dir or --recipients')
    .addOption(keyOption())
    .option('--image <logo.png>', 'picture to embed; with scheme paper of the key\'s size (default: none)')
    .option('--id <hex>', '64-bit ID to embed, 1 to 16 hexadecimal digits (default: none)')
    .option('--text <text>', 'text to embed, up to 64 bytes (scheme robust, like the next five; default: none)')
    .addOption(new Option('--strength <preset>', 'how much the mark may change and withstand (default: standard)').choices(STRENGTHS))
    .option('--max-error <share>', 'largest displacement, fraction of the diagonal (default: the strength\'s own)', parseNumber)
    .option('--max-slide <share>', 'largest displacement along the surface, fraction of the diagonal (default: the strength\'s own)', parseNumber)
    .option('--salt <text>', 'name of the asset; extract takes the same one (default: empty)')
    .option('--self-test', 'damage the marked model in six ways and report which it withstands (default: off)')
    .addOption(schemeOption('fail unless the key is for this scheme (default: the key\'s)'))
    .option('--out-dir <dir>', 'write each marked model here under its own name (default: OUT is given)')
    .option('--recipients <list.csv>', 'mark one copy for each recipient in DIR/RECIPIENT/, by an ID of its own or the picture in the column image (default: none)')
    .option('--registry <reg.jsonl>', 'note who got which mark here; goes with --recipients (default: none)')
    .option(...jobs)
    .addOption(setOption('parameter of the key to override, for reading too (repeatable; default: the key\'s)'))
    .option(...dryRun)
    .option(...force);

  define('extract', 'read the mark of models', extractCommand)
    .argument('<files...>', 'models or globs')
    .addOption(keyOption())
    .option('--reference <logo.png>', 'compare with this picture (default: none)')
    .option('--expect-id <hex>', 'is it this ID? (scheme robust, like the next two; default: none)')
    .option('--expect-text <text>', 'is it this text? (default: none)')
    .option('--salt <text>', 'name of the asset, as given to embed (default: empty)')
    .option('--image-out <mark.png>', 'write the picture that was read (default: do not)')
    .option('--confidence-out <map.png>', 'write how certain each pixel is (default: do not)')
    .option('--out-dir <dir>', 'write both pictures of each model here as NAME.mark.png and NAME.confidence.png (default: do not)')
    .option(...jobs)
    .addOption(setOption('parameter of the key to override (repeatable; default: the key\'s)'))
    .option(...dryRun)
    .option(...force);

  define('trace', 'name the recipient of a leaked copy', traceCommand)
    .argument('<files...>', 'models or globs')
    .addOption(keyOption())
    .requiredOption('--registry <reg.jsonl>', 'what embed --recipients wrote, needed')
    .option('--salt <text>', 'only entries with this salt (default: all)')
    .option('--jobs <count>', 'compare with this many candidates at once, in threads; 0 takes one per processor', parseWhole, 1);

  define('inspect', 'describe models without a key', inspectCommand)
    .argument('<files...>', 'models or globs')
    .option(...jobs);

  define('attack', 'damage a model on purpose, to see what a mark withstands', attackCommand)
    .argument('<in>', 'model')
    .argument('<out>', 'new PLY or GLB file')
    .addOption(new Option('--kind <kind>', 'what to do, needed').choices(Object.keys(ATTACKS)).makeOptionMandatory())
    .option('--amount <number>', 'how much; the meaning, and whether there is a default, depends on the kind', parseNumber)
    .option('--variant <name>', 'which form of the kind (default: the kind\'s own)')
    .option('--iterations <count>', 'how often (smooth; default: the kind\'s own)', parseWhole)
    .option('--seed <number>', 'of the random numbers', parseWhole, 1)
    .addOption(new Option('--format <format>', 'of OUT (default: by its name, else ply)').choices(['ply', 'glb']))
    .option(...dryRun)
    .option(...force)
    .addHelpText('after', `\nKinds:\n${Object.entries(ATTACKS).map(([kind, what]) => `  ${kind.padEnd(12)} ${what}`).join('\n')}`);

  defineServe(define);

  // These two speak of the grammar itself.
  program.command('completion').description('print a completion script for a shell')
    .addHelpText('after', '\nbash: eval "$(quadmark completion bash)"; zsh and fish: save it where the shell looks for completions.')
    .addArgument(program.createArgument('<shell>', 'whose').choices(SHELLS))
    .action((shell) => { process.stdout.write(completionScript(program, shell)); });
  program.command('man').description('print this help as a manual page, for man -l -')
    .action(() => { process.stdout.write(manualPage(program)); });
  for (const command of program.commands) command.exitOverride().configureHelp({ helpWidth: 100 });
  return program;
}

/**
 * Runs one command line.
 * @param argv  arguments after the program's name
 * @return the exit status
 */
export async function run(argv) {
  let status = EXIT.done;
  try {
    await createProgram((result) => { status = result; }).parseAsync(argv, { from: 'user' });
    return status;
  } catch (error) {
    if (error instanceof CommanderError) return error.exitCode === 0 ? EXIT.done : EXIT.usage;
    throw error;
  }
}
