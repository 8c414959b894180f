// SPDX-License-Identifier: MIT
// Rows about tools as tables: a short one for README.md, full ones for docs/evaluation.md.
import { readings, recoveredCell, measuredTable } from '../cells.mjs';
import { tableOf } from '../../support/table.mjs';
import { labelOf, OURS, TOOL_LINES } from './lines.mjs';
import { attackOf } from './trial.mjs';

const unique = (list) => [...new Set(list)];
const count = (rows, outcome) => rows.filter((row) => row.outcome === outcome).length;
const programOf = (line) => line.split(' | ').at(-1).split(' ')[0];

/** All rows about tools, by command line. */
function byLine({ rows }) {
  const of = new Map(TOOL_LINES.map(({ line }) => [line, []]));
  for (const row of rows.select({ attack: (attack) => attack.startsWith('tool:') })) of.get(row.attack.slice('tool:'.length))?.push(row);
  return [...of].filter(([, list]) => list.length > 0);
}

/** Those of our marks that were measured at all. */
const oursIn = ({ rows }) =>
  OURS.filter(({ scheme, settings }) => rows.select({ scheme, settings, attack: (attack) => attack.startsWith('tool:') }).length > 0);

const ofScheme = (list, { scheme, settings }) => list.filter((row) => row.scheme === scheme && row.settings === settings);
const peersIn = (list) => unique(list.map((row) => row.scheme)).filter((scheme) => !OURS.some((one) => one.scheme === scheme));

/** "24 of 24"; "22 + 2 of 24": two more were recognised by comparing with the ID that is expected. */
function survived(list) {
  const read = readings(list);
  if (read.length === 0) return list.length === 0 ? 'not measured' : recoveredCell(list).text;
  return `${recoveredCell(list).text} of ${read.length}`;
}

/** How much of the marks came back, recognised ones last, for choosing the best of several schemes. */
function share(list) {
  const read = readings(list);
  return read.length === 0 ? -1 : (count(read, 'exact') + count(read, 'match') / 1e3) / read.length;
}

function bestPeer(list) {
  const peers = peersIn(list);
  if (peers.length === 0) return 'not measured';
  const best = peers.map((scheme) => ({ scheme, rows: list.filter((row) => row.scheme === scheme) }))
    .reduce((a, b) => (share(b.rows) > share(a.rows) ? b : a));
  return share(best.rows) > 0 ? `\`${best.scheme}\` ${survived(best.rows)}` : survived(best.rows);
}

/** Why nothing came out of a command line at all, or null. */
function notRun(list) {
  const failed = list.filter((row) => row.outcome === 'failed');
  return failed.length > 0 && readings(list).length === 0 ? `not run: ${failed[0].note}` : null;
}

const versionOf = (line, { tools = {} }) => {
  const program = programOf(line);
  return `${program} ${tools[program] ?? '(version unknown)'}`;
};

function trialsLine(context) {
  const rows = byLine(context).flatMap(([, list]) => list);
  const ours = rows.filter((row) => OURS.some((one) => one.scheme === row.scheme)), peers = rows.filter((row) => !ours.includes(row));
  const models = (list) => unique(list.map((row) => row.model)).sort().join(', ');
  const keys = (list) => {
    const number = unique(list.map((row) => row.seed)).length;
    return number === 1 ? 'one key each' : `up to ${number} keys each`;
  };
  const other = peers.length === 0 ? '' : ` Peers (${unique(peers.map((row) => `\`${row.scheme}\``)).join(', ')}): ${models(peers)}, ${keys(peers)}.`;
  return `64-bit IDs, each scheme at its usual strength, in ${models(ours)}, ${keys(ours)}.${other}`;
}

/** The table of README.md, of a recordedContext(). */
export function shortTable(context) {
  const { machine } = context;
  const rows = byLine(context).map(([line, list]) => {
    const why = notRun(list);
    const cells = why ? [why, '', '', ''] : [...OURS.map((one) => survived(ofScheme(list, one))), bestPeer(list)];
    return [labelOf(line), versionOf(line, machine), ...cells];
  });
  return `${tableOf(['after', 'version', ...OURS.map(({ head }) => head), 'best peer'], rows)}

Measured ${machine.date}. ${trialsLine(context)} "n of m": that many were read back, every bit right, without the original and
without knowing the ID; "+ n": so many more are recognised when the expected ID is given (chance of a false alarm at most 1e-6).`;
}

/** What a tool made of our marks, by the rows' notes: mean share of the vertices that are left, and bits of its grid. */
function madeCells(list) {
  const ours = list.filter((row) => row.scheme === OURS[0].scheme);  // some peers put models onto a grid themselves
  const notes = readings(ours).map((row) => /^(\d+) of (\d+) vertices(?:, (\d+) bits)?/.exec(row.note ?? '')).filter(Boolean);
  if (notes.length === 0) return ['', ''];
  const left = notes.reduce((sum, [, after, before]) => sum + after / before, 0) / notes.length;
  const bits = unique(notes.map(([, , , digits]) => digits ?? 'float')).sort();
  return [`${(100 * left).toFixed(1)} %`, bits.join(', ')];
}

function allSchemes(context) {
  const lines = byLine(context), ours = oursIn(context), peers = unique(lines.flatMap(([, list]) => peersIn(list)));
  return measuredTable(['after', 'vertices left', 'bits', ...ours.map(({ head }) => head), ...peers.map((scheme) => `\`${scheme}\``)],
    lines.filter(([, list]) => !notRun(list)).map(([line, list]) => [labelOf(line), ...madeCells(list),
      ...ours.map((one) => recoveredCell(ofScheme(list, one))),
      ...peers.map((scheme) => recoveredCell(list.filter((row) => row.scheme === scheme)))]));
}

function byModel(context, one) {
  const lines = byLine(context).map(([line, list]) => [line, ofScheme(list, one)]).filter(([, list]) => list.length > 0 && !notRun(list));
  const models = unique(lines.flatMap(([, list]) => list.map((row) => row.model))).sort();
  return measuredTable(['after', ...models],
    lines.map(([line, list]) => [labelOf(line), ...models.map((model) => recoveredCell(list.filter((row) => row.model === model)))]));
}

function failures(context) {
  const told = byLine(context).flatMap(([line, list]) => {
    const failed = list.filter((row) => row.outcome === 'failed');
    return unique(failed.map((row) => row.note)).map((note) => {
      const these = failed.filter((row) => row.note === note);
      return `- ${labelOf(line)}, ${these.length} of ${list.length} (${unique(these.map((row) => row.model)).join(', ')}): ${note}`;
    });
  });
  return told.length === 0 ? '' : `\n\nWhat failed for the tool's own reasons, or could not be run:\n\n${told.join('\n')}`;
}

function refusals(context) {
  const rows = byLine(context).flatMap(([, list]) => list).filter((row) => row.outcome === 'refused');
  const told = unique(rows.map((row) => `\`${row.scheme}\` (${row.settings}) on ${row.model}: ${row.note}`)).sort();
  return told.length === 0 ? '' : `\n\nMarks that were refused, and are no trials: ${told.join('; ')}.`;
}

/** The section of docs/evaluation.md. */
export function fullTables(context) {
  if (byLine(context).length === 0) return 'Not measured.';
  return `Each scheme's 64-bit mark is written into a GLB, which goes through the real program; its result is read. "n": read back with every bit
right; "+ n": so many more are recognised by comparing with the expected ID (tail at most 1e-6). The file is looked at as well:
how many distinct positions are left, and the grid they lie on; a tool that did not do what its command line says is a failure of the
tool. "Object of 1/20 of its scene": beside an object whose box is 20 times as large, of the same material, so that
tools join the two. draco_encoder reads a PLY of the same positions; OBJ and STL come back as a GLB by the program that wrote them.
${trialsLine(context)} How much each scheme moves is under "Distortion of every scheme".

${allSchemes(context)}

${oursIn(context).map((one) => `${one.head} by model:\n\n${byModel(context, one)}`).join('\n\n')}${failures(context)}${refusals(context)}`;
}

/** Where a peer brings back a larger share of its marks than our own scheme at its usual strength: for the conclusion. */
export function lossesByTool(context) {
  const [ours] = OURS;
  return byLine(context).flatMap(([line, list]) => {
    const mine = ofScheme(list, ours);
    return peersIn(list).flatMap((scheme) => {
      const theirs = list.filter((row) => row.scheme === scheme);
      const same = mine.filter((row) => theirs.some((other) => other.model === row.model && other.seed === row.seed));
      if (readings(same).length === 0 || share(theirs) <= share(same)) return [];
      return [{ where: `tools: ${labelOf(line)}`, ours: `\`robust\` ${survived(same)}`, theirs: `\`${scheme}\` ${survived(theirs)}` }];
    });
  });
}
