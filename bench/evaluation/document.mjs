// SPDX-License-Identifier: MIT
// docs/evaluation.md, made of the rows.
import { writeFileSync } from 'node:fs';
import { tableOf } from '../support/table.mjs';
import { experiments } from './experiments.mjs';

function head({ machine, rows, quick }) {
  const versions = (of) => Object.entries(of).map(([name, version]) => `${name} ${version}`).join(', ');
  return `# Evaluation

Made by \`bench/evaluate${quick ? ' --quick' : ''}\` of ${rows.select().length} measured rows. How it is measured, and what the
columns of the rows mean: [bench/README.md](../bench/README.md). An unread bit counts as half a wrong one.

${machine.date}, commit ${machine.commit}, quadmark ${machine.quadmark}, ${machine.compiler}, Node ${machine.node}; ${machine.cpu}, ${machine.cores} cores,
${machine.memoryGiB} GiB, ${machine.system}; ${versions(machine.libraries)}.${Object.keys(machine.tools).length > 0 ? ` Tools: ${versions(machine.tools)}.` : ''}
`;
}

function schemesTable({ schemes }) {
  const peers = schemes.filter(({ peer }) => peer).map(({ name, peer }) => [`\`${name}\``,
    [peer.authors, peer.title, peer.venue, peer.year || ''].filter((text) => text !== '').join(', '), peer.blind ? 'yes' : 'no', peer.carrier, peer.settings, peer.decided, peer.validation]);
  return `\`robust\` is ours and the product's default, \`paper\` the affine-invariant scheme of Gao, Zhang, Huang and Deng (ACM TOMM 2012). The
others were written from their papers, to be measured beside them, each given its best:

${tableOf(['scheme', 'source', 'blind', 'what carries a bit', 'settings', 'left open there and decided here', 'validated by'], peers)}

Every payload is XORed with a pad of the key before a scheme gets it, so that the bits of a reading without the mark are coin flips.
Where a scheme has no bound of its own on chance, the binomial tail of the bits that agree is taken. "exact": all bits are right,
and known to be right by the scheme or a tail of at most 1e-6; "recognised": a tail of at most 1e-6 with some bits wrong or unread.`;
}

/** Row by row where we lose, as the experiments find it in the rows. */
function conclusion(context) {
  const losses = experiments.flatMap((experiment) => experiment.losses?.(context) ?? []);
  if (losses.length === 0) return 'In none of the rows above does a peer or the paper do better than our schemes.';
  return `Where a peer or the paper does better than our scheme that it is compared with; everywhere else in the tables that name both,
ours is as good or better. A peer whose bits agree no more than coin flips do, at the level of 1 %, is not better than nothing. In
parentheses: the number of trials.

${tableOf(['where', 'ours', 'theirs'], losses.map(({ where, ours, theirs }) => [where, ours, theirs]))}`;
}

/** A table of rows that have no figures: one line for those that agree in some columns, with the first one's reason. */
function reasonsTable(rows, columns) {
  const lines = new Map();
  for (const row of rows) {
    const cells = columns.map((column) => row[column]), name = cells.join('\n');
    if (!lines.has(name)) lines.set(name, { cells, times: 0, note: row.note ?? '' });
    ++lines.get(name).times;
  }
  return tableOf([...columns, 'times', 'why (the first time)'],
    [...lines.values()].map(({ cells, times, note }) => [...cells, times, note].map((cell) => String(cell).replaceAll('|', '\\|'))));
}

/** What has no figure in the tables above, and why. */
function withoutFigures({ rows }) {
  const refused = rows.select({ attack: 'mark', outcome: 'refused' }), failed = rows.select({ outcome: 'failed' });
  const parts = [];
  if (refused.length > 0) parts.push(`Nothing was written:\n\n${reasonsTable(refused, ['scheme', 'settings', 'payload', 'model'])}`);
  if (failed.length > 0) parts.push(`The attack or tool failed:\n\n${reasonsTable(failed, ['attack', 'model'])}`);
  return parts.join('\n\n') || 'Every marking was written, and every attack and tool did its work.';
}

/** @param context  as recordedContext() gives it */
export function writeDocument(path, context) {
  const sections = experiments.map((experiment) => `## ${experiment.title}\n\n${experiment.document(context).trim()}\n`);
  writeFileSync(path, [head(context), `## The schemes\n\n${schemesTable(context)}\n`, ...sections, `## What has no figures, and why\n\n${withoutFigures(context)}\n`,
    `## Where we lose\n\n${conclusion(context)}\n`].join('\n'));
}
