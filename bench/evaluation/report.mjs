// SPDX-License-Identifier: MIT
// report.html: what was measured, as plots and pictures. One file that needs neither scripts nor a network.
import { readFileSync, writeFileSync } from 'node:fs';
import { experiments } from './experiments.mjs';
import { affineSection, toolSection } from './report/heat.mjs';
import { lirisSection, paperSection } from './report/attacks.mjs';
import { chanceSection } from './report/chance.mjs';
import { cropSection } from './report/crops.mjs';
import { capacitySection, noiseSection } from './report/digits.mjs';
import { distortionSection } from './report/distortion.mjs';
import { htmlTable } from './report/figure.mjs';
import { escape } from './report/plot.mjs';
import { renderingSection } from './report/renderings.mjs';

const SECTIONS = [
  [
    'liris',
    'All schemes at equal distortion',
    lirisSection,
    `The LIRIS protocol (Wang et al. 2010). An ID of robust comes back whole or not at all: its errors are 0 or 50 % per
trial.`,
  ],
  ['tools', 'After the programs of web builds', toolSection],
  ['distortion', 'What a mark does to a model', distortionSection],
  ['seen', 'Before and after', renderingSection],
  [
    'chance',
    'False positives',
    chanceSection,
    'Models that carry no mark of the key they are read with: none at all, another key’s, or another scheme’s.',
  ],
  ['crops', 'Cropping', cropSection],
  ['attacks', 'The paper’s attacks', paperSection],
  ['affine', 'Affine maps', affineSection],
  ['digits', 'Digits and distortion', capacitySection],
  ['noise', 'Digits and noise', noiseSection],
];

function lossSection(context) {
  const losses = experiments.flatMap((experiment) => experiment.losses?.(context) ?? []);
  if (losses.length === 0) return '<p>In none of the rows does a peer or the paper do better than our schemes.</p>';
  const plain = (text) => text.replaceAll('`', '');
  return `<p>Where a peer or the paper does better than our scheme that it is compared with; in parentheses the number of trials.</p>${htmlTable(
    ['where', 'ours', 'theirs'],
    losses.map(({ where, ours, theirs }) => [where, ours, theirs].map(plain)),
  )}`;
}

/** Whose each scheme is, and how it was checked. */
function schemeSection({ schemes }) {
  const mine = {
    robust: 'quadmark’s own, blind, for web builds',
    paper: 'Gao, Zhang, Huang, Deng 2012, as the product has it, blind',
  };
  return htmlTable(
    ['scheme', 'whose', 'usual settings', 'checked by'],
    schemes.map(({ name, usualSettings, peer }) => [
      name,
      peer
        ? `${peer.authors}: ${peer.title}. ${peer.venue}, ${peer.year}; ${peer.blind ? 'blind' : 'needs the original'}`
        : (mine[name] ?? ''),
      usualSettings,
      peer?.validation ?? 'the tests of the product',
    ]),
  );
}

function facts({ machine, rows, schemes }) {
  const all = rows.select(),
    unique = (column) => new Set(all.map((row) => row[column])).size;
  const entries = {
    measured: `${all.length} rows: ${schemes.length} schemes, ${unique('model')} models, ${unique('attack')} attacks and tools, ${unique('seed')} key${unique('seed') === 1 ? '' : 's'}`,
    when: `${machine.date}, commit ${machine.commit}, quadmark ${machine.quadmark}`,
    'on what': `${machine.cpu}, ${machine.cores} cores, ${machine.memoryGiB} GiB, ${machine.system}`,
    'with what': [
      machine.compiler,
      `Node ${machine.node}`,
      ...Object.entries(machine.tools).map(([name, version]) => `${name} ${version}`),
    ].join(', '),
  };
  return `<dl class="facts">${Object.entries(entries)
    .map(([name, text]) => `<div><dt>${name}</dt><dd>${escape(text)}</dd></div>`)
    .join('')}</dl>`;
}

/** @param context  of recordedContext() */
export async function writeReport(path, context) {
  const css = readFileSync(new URL('./report/report.css', import.meta.url), 'utf8').replace(/^\/\*.*\*\/\n/, '');
  const sections = [];
  for (const [id, title, make, lead = ''] of SECTIONS) {
    sections.push({ id, title, html: `${lead ? `<p>${escape(lead)}</p>` : ''}${await make(context)}` });
  }
  sections.push({ id: 'schemes', title: 'The schemes', html: schemeSection(context) });
  sections.push({ id: 'losses', title: 'Where we lose', html: lossSection(context) });
  writeFileSync(
    path,
    `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>quadmark: evaluation</title>
<style>
${css}</style>
</head>
<body>
<a class="skip" href="#${sections[0].id}">To the figures</a>
<header>
<h1>Evaluation</h1>
<p class="lead">What survives, what it costs, and how often chance looks like a mark: the schemes of quadmark beside
those of other people, on the same models with the same attacks. Every number is measured, and stands with the count of
its trials in the table behind its figure.</p>
${facts(context)}
<nav aria-label="Sections"><ol>${sections.map(({ id, title }) => `<li><a href="#${id}">${escape(title)}</a></li>`).join('')}</ol></nav>
</header>
<main>
${sections.map(({ id, title, html }) => `<section id="${id}" aria-labelledby="${id}-title"><h2 id="${id}-title">${escape(title)}</h2>\n${html}\n</section>`).join('\n')}
</main>
<footer>Made by <code>bench/evaluate${context.quick ? ' --quick' : ''}</code>. What the columns mean and how it is
measured: bench/README.md; all tables in words: docs/evaluation.md. Medians stand with their quartiles; an unread bit
counts as half a wrong one.</footer>
</body>
</html>
`,
  );
}
