// SPDX-License-Identifier: MIT
// docs/evaluation.md, made of the rows.
import { writeFileSync } from 'node:fs';

function head({ machine, rows, quick }) {
  const tools = Object.entries(machine.tools).map(([name, version]) => `${name} ${version}`).join(', ');
  return `# Evaluation

Made by \`bench/evaluate${quick ? ' --quick' : ''}\` of ${rows.select().length} measured rows. How it is measured, and what the
columns of the rows mean: [bench/README.md](../bench/README.md). An unread bit counts as half a wrong one.

${machine.date}, commit ${machine.commit}, quadmark ${machine.quadmark}, ${machine.compiler}, Node ${machine.node}; ${machine.cpu}, ${machine.cores} cores,
${machine.memoryGiB} GiB, ${machine.system}.${tools ? ` Tools: ${tools}.` : ''}
`;
}

export function writeDocument(path, context) {
  const sections = context.experiments.map((experiment) => `## ${experiment.title}\n\n${experiment.document(context).trim()}\n`);
  writeFileSync(path, [head(context), ...sections].join('\n'));
}
