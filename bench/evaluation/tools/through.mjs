// SPDX-License-Identifier: MIT
// A model through a command line of lines.mjs.
import { noChromium } from '../../../js_tests/support/chromium.mjs';
import { openThree } from '../../../js_tests/support/three.mjs';
import { missing, runTool, toolVersion } from '../../../js_tests/support/tools.mjs';
import { describe, describeModel, disappointment } from './made.mjs';
import { besideLarge } from './scene.mjs';

const stepsOf = (line) => line.split(' | ');
const isThree = (step) => step.startsWith('three ');
const isScene = (step) => step.startsWith('scene 1/');

/** Why a command line cannot be run on this machine, or null. */
export function notHere(line) {
  for (const step of stepsOf(line)) {
    const reason = isScene(step) ? null : isThree(step) ? noChromium && `not installed: ${noChromium}` : missing(step);
    if (reason) return reason;
  }
  return null;
}

/** Everything that command lines need; close() ends it. */
export function openTools() {
  const endings = [];
  let opened = null;
  // Opened by the first line that wants it, and by the next one where that failed.
  const three = () => (opened ??= openThree({ after: (end) => endings.push(end) }).catch((error) => {
    opened = null;
    throw error;
  }));
  const known = new WeakMap();  // one marked model goes through many tools
  const describeOnce = (model) => {
    if (!known.has(model)) known.set(model, describeModel(model));
    return known.get(model);
  };
  let turn = Promise.resolve();
  /** One call of the page at a time: it keeps one model's files and complaints. A browser that went away is opened again, once. */
  const written = (exporter, model) => {
    const result = turn.then(async () => {
      try {
        return await (await three()).written(exporter, model);
      } catch (error) {
        if (!/has been closed/.test(error.message)) throw error;
        opened = null;
        return (await three()).written(exporter, model);
      }
    });
    turn = result.catch(() => {});
    return result;
  };

  return {
    /**
     * @param tool  of TOOL_LINES
     * @return { bytes, note }: the file that the last step wrote, and what it made; where it failed { bytes: null, note }
     * @throws Error where a browser is wanted that does not open: that says nothing of the tool
     */
    async through({ line, expects }, glb) {
      if (stepsOf(line).some(isThree) && notHere(line) === null) await three();
      try {
        let bytes = glb, before = glb;
        for (const step of stepsOf(line)) {
          if (isScene(step)) {
            before = bytes = await besideLarge(bytes, Number(step.slice('scene 1/'.length)));
          } else if (isThree(step)) {
            if (notHere(step)) throw new Error(notHere(step));
            bytes = await written(step.slice('three '.length), bytes);
          } else {
            bytes = await runTool(step, bytes);
          }
        }
        const was = await describeOnce(before), made = await describeModel(bytes);
        const wrong = disappointment(expects, made, was);
        return wrong ? { bytes: null, note: `${line}: ${wrong}` } : { bytes, note: describe(made, was) };
      } catch (error) {
        return { bytes: null, note: error.message.replace(/\s+/g, ' ').trim().slice(0, 300) };
      }
    },

    /** { program: version } of the programs of these lines that are here, as they say themselves. */
    async versions(tools) {
      const steps = tools.flatMap(({ line }) => stepsOf(line)).filter((step) => !isScene(step) && notHere(step) === null);
      const byProgram = new Map(steps.map((step) => [step.split(' ')[0], step]));
      const asked = [...byProgram].map(async ([program, step]) =>
        [program, isThree(step) ? `r${await (await three()).version()}` : await toolVersion(step)]);
      return Object.fromEntries(await Promise.all(asked));
    },

    async close() {
      for (const end of endings) await end();
    },
  };
}
