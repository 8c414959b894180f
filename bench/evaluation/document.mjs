// SPDX-License-Identifier: MIT
// docs/evaluation.md, made of the rows.
import { writeFileSync } from 'node:fs';
import { tableOf } from '../support/table.mjs';
import { experiments } from './experiments.mjs';

function head({ machine, rows, quick }) {
  const tools = Object.entries(machine.tools).map(([name, version]) => `${name} ${version}`).join(', ');
  return `# Evaluation

Made by \`bench/evaluate${quick ? ' --quick' : ''}\` of ${rows.select().length} measured rows. How it is measured, and what the
columns of the rows mean: [bench/README.md](../bench/README.md). An unread bit counts as half a wrong one.

${machine.date}, commit ${machine.commit}, quadmark ${machine.quadmark}, ${machine.compiler}, Node ${machine.node}; ${machine.cpu}, ${machine.cores} cores,
${machine.memoryGiB} GiB, ${machine.system}.${tools ? ` Tools: ${tools}.` : ''}
`;
}

/** Row by row where we lose, as the experiments find it in the rows. */
function conclusion(context) {
  const losses = experiments.flatMap((experiment) => experiment.losses?.(context) ?? []);
  if (losses.length === 0) return 'In none of the rows above does a peer or the paper do better than our schemes.';
  return `Where a peer or the paper does better than our scheme that it is compared with; everywhere else in the tables that name both,
ours is as good or better. In parentheses: the number of trials.

${tableOf(['where', 'ours', 'theirs'], losses.map(({ where, ours, theirs }) => [where, ours, theirs]))}`;
}

/** @param context  as recordedContext() gives it */
export function writeDocument(path, context) {
  const sections = experiments.map((experiment) => `## ${experiment.title}\n\n${experiment.document(context).trim()}\n`);
  writeFileSync(path, [head(context), ...sections, `## Where we lose\n\n${conclusion(context)}\n`].join('\n'));
}
