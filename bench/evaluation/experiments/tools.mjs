// SPDX-License-Identifier: MIT
import { isPresent, QUICK_MODELS } from '../models.mjs';
import { OURS, TOOL_LINES } from '../tools/lines.mjs';
import { fullTables, lossesByTool } from '../tools/tables.mjs';
import { notHere, openTools } from '../tools/through.mjs';
import { attackOf, runTrial } from '../tools/trial.mjs';

export const name = 'tools';
export const title = 'Survival by tool name and version';

// Tools take seconds where attacks of our own take milliseconds: fewer keys and models than elsewhere.
const SEEDS = 3, PEER_SEEDS = 1;
const MODELS = ['fandisk.glb', 'rocker-arm.glb', 'Duck.glb', 'beast.glb', 'bunny.glb', 'clothFolds.glb', 'SheenCloth.glb', 'nefertiti.glb'];
const PEER_MODELS = ['fandisk.glb', 'rocker-arm.glb', 'bunny.glb'];

const linesOf = ({ quick }) => TOOL_LINES.filter((tool) => !quick || tool.quick);

/** Who marks what: [{ scheme, settings, payload, model, seed }], first seeds first, ours before the others. */
function trialsOf({ quick, seeds, schemes }) {
  const trials = (marks, models, seed) => models.filter(isPresent)
    .flatMap((model) => marks.map(({ scheme, settings }) => ({ scheme, settings, payload: 'id', model, seed })));
  if (quick) return trials(OURS.filter(({ settings }) => settings !== 'strong'), QUICK_MODELS.slice(0, 1), seeds[0]);
  const peers = schemes.filter(({ name: scheme }) => !OURS.some((mark) => mark.scheme === scheme))
    .map(({ name: scheme, usualSettings: settings }) => ({ scheme, settings }));
  return seeds.slice(0, SEEDS).flatMap((seed) =>
    [...trials(OURS, MODELS, seed), ...(seed <= PEER_SEEDS ? trials(peers, PEER_MODELS, seed) : [])]);
}

/** Tools that were missing when a row was written, and are there now, get another chance. */
function forgetMissing({ rows }) {
  const back = new Set(TOOL_LINES.filter(({ line }) => notHere(line) === null).map(({ line }) => attackOf(line)));
  rows.forget((row) => row.outcome === 'failed' && back.has(row.attack) && /^not installed: /.test(row.note));
}

export async function run(context) {
  const { rows, signal, progress, parallel } = context, errors = [];
  forgetMissing(context);
  const open = trialsOf(context)
    .map((trial) => ({ trial, list: linesOf(context).filter((tool) => !rows.has({ ...trial, attack: attackOf(tool.line) })) }))
    .filter(({ list }) => list.length > 0);
  progress.expect(open.length);
  const tools = openTools();
  const serve = async () => {
    while (open.length > 0 && !signal.aborted) {
      const { trial, list } = open.shift(), label = `tools: ${trial.scheme} ${trial.settings} ${trial.model} ${trial.seed}`;
      let done = 0;
      try {
        await runTrial(trial, list, tools, (row) => {
          rows.add(row);
          progress.update(label, ++done / list.length);
        }, () => signal.aborted);
      } catch (error) {
        errors.push(`${label}: ${error.message}`);
      }
      progress.ended(label);
    }
  };
  try {
    await Promise.all(Array.from({ length: parallel }, serve));
  } finally {
    await tools.close();
  }
  return errors;
}

/** { program: version } of those that are here. */
export async function tools(context) {
  const programs = openTools();
  try {
    return await programs.versions(linesOf(context));
  } finally {
    await programs.close();
  }
}

export const losses = lossesByTool;
export const document = fullTables;
