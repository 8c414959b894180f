// SPDX-License-Identifier: MIT
// One marked model through command lines: a row for each.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { modelPath } from '../models.mjs';
import { askWorker } from '../worker.mjs';

/** How the results name a command line. */
export const attackOf = (line) => `tool:${line}`;

/** The extension that the native reader wants to see. */
const extensionOf = (bytes) => {
  const start = bytes.toString('latin1', 0, 5);
  return start === 'DRACO' ? 'drc' : start.startsWith('ply') ? 'ply' : 'glb';
};

/**
 * Marks a model once, sends it through each tool, reads what comes out.
 *
 * @param trial      { scheme, settings, payload, model, seed }: what every row says
 * @param list       of TOOL_LINES
 * @param tools      openTools()
 * @param add        called with each row as soon as it is known
 * @param stopped    whether to leave it at that: asked before each tool, and when one fails
 */
export async function runTrial(trial, list, tools, add, stopped = () => false) {
  const { scheme, settings, payload, model, seed } = trial;
  const folder = mkdtempSync(join(tmpdir(), 'quadmark-trial-'));
  try {
    const file = join(folder, 'marked.glb');
    const { outcome, note } = await askWorker('mark', scheme, settings, payload, modelPath(model), String(seed), file);
    const rowOf = (tool, columns) => ({ ...trial, attack: attackOf(tool.line), ...columns });
    if (outcome !== 'written') {
      for (const tool of list) add(rowOf(tool, { outcome, note }));
      return;
    }
    const glb = readFileSync(file);
    for (const tool of list) {
      if (stopped()) return;
      const made = await tools.through(tool, glb);
      if (made.bytes === null) {
        if (stopped()) return;  // what stops us stops the tool
        add(rowOf(tool, { outcome: 'failed', note: made.note }));
        continue;
      }
      const path = join(folder, `made.${extensionOf(made.bytes)}`);
      writeFileSync(path, made.bytes);
      add(rowOf(tool, { ...await askWorker('read', scheme, settings, payload, path, String(seed)), note: made.note }));
    }
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}
