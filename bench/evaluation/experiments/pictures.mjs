// SPDX-License-Identifier: MIT
// What may be seen of a mark: models before and after, drawn by three in Chromium, and how far the pixels are apart.
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { noChromium } from '../../../js_tests/support/chromium.mjs';
import { openThree } from '../../../js_tests/support/three.mjs';
import { tableOf } from '../../support/table.mjs';
import { isPresent, modelPath } from '../models.mjs';
import { askWorker } from '../worker.mjs';

export const name = 'pictures';
export const title = 'Before and after';

/** The difference is shown so many times as strong as it is. */
export const AMPLIFY = 8;
const SEED = 1;
const every = ({ schemes }) => schemes.map(({ name: scheme, usualSettings: settings }) => ({ scheme, settings }));
const ours = (context) => every(context).filter(({ scheme }) => scheme === 'robust' || scheme === 'paper');

/** What is drawn: { scheme, settings, payload, model }. */
export const subjects = (context) =>
  (context.quick
    ? [['sculpture:8000:1', ours(context)]]
    : [
        ['bunny.ply', [{ scheme: 'robust', settings: 'invisible' }, ...every(context)]],
        ['fandisk.ply', ours(context)],
        ['Duck.glb', ours(context).slice(0, 1)],
      ]
  ).flatMap(([model, marks]) => marks.map((mark) => ({ ...mark, payload: 'id', model })));

const same = (a, b) => ['scheme', 'settings', 'payload', 'model'].every((key) => a[key] === b[key]);
const recordFile = ({ folder }) => join(folder, 'renderings.json');

/** [{ ...subject, before, after, difference: files, covered, most, mean } or { ...subject, note }] */
export const renderings = (context) =>
  existsSync(recordFile(context)) ? JSON.parse(readFileSync(recordFile(context), 'utf8')) : [];

async function draw(three, context, subject) {
  const { scheme, settings, payload, model } = subject;
  const folder = mkdtempSync(join(tmpdir(), 'quadmark-picture-'));
  try {
    const extension = extname(model) === '.glb' ? 'glb' : 'ply',
      plain = join(folder, `plain.${extension}`),
      marked = join(folder, `marked.${extension}`);
    await askWorker('write', modelPath(model), plain);
    const { outcome, note } = await askWorker(
      'mark',
      scheme,
      settings,
      payload,
      modelPath(model),
      String(SEED),
      marked,
    );
    if (outcome !== 'written') return { note: `${outcome}: ${note}` };
    const { before, after, difference, ...figures } = await three.pictures(
      { model: readFileSync(plain) },
      { model: readFileSync(marked) },
      AMPLIFY,
    );
    const place = (...words) =>
      `renderings/${words
        .filter(Boolean)
        .join('-')
        .replace(/[^\w.-]/g, '_')}.webp`;
    mkdirSync(join(context.folder, 'renderings'), { recursive: true });
    const pictures = [
      ['before', before, place(model)],
      ['after', after, place(model, scheme, settings)],
      ['difference', difference, place(model, scheme, settings, 'difference')],
    ];
    const files = pictures.map(([what, url, file]) => {
      writeFileSync(join(context.folder, file), Buffer.from(url.split(',')[1], 'base64'));
      return [what, file];
    });
    return { ...figures, ...Object.fromEntries(files) };
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

export async function run(context) {
  const there = renderings(context),
    errors = [];
  const open = subjects(context).filter(
    (subject) => isPresent(subject.model) && !there.some((one) => same(one, subject)),
  );
  if (open.length === 0) return errors;
  if (noChromium) return [`pictures: ${noChromium}`];
  context.progress.expect(open.length);
  const hooks = [];
  try {
    const three = await openThree({ after: (hook) => hooks.push(hook) });
    for (const subject of open) {
      if (context.signal.aborted) break;
      const label = `picture: ${subject.scheme}, ${subject.model}`;
      try {
        there.push({ ...subject, ...(await draw(three, context, subject)) });
        writeFileSync(recordFile(context), `${JSON.stringify(there, null, 1)}\n`);
      } catch (error) {
        errors.push(`${label}: ${error.message}`);
      }
      context.progress.ended(label);
    }
  } catch (error) {
    errors.push(`pictures: Chromium: ${error.message}`);
  } finally {
    for (const hook of hooks) await hook();
  }
  return errors;
}

export function document(context) {
  const made = renderings(context);
  const rows = subjects(context).map((subject) => {
    const one = made.find((other) => same(other, subject));
    const why = one?.note ?? 'not drawn: the model or Chromium was not there';
    return [
      subject.model,
      subject.scheme,
      subject.settings,
      ...(one?.before ? [one.most, one.mean.toFixed(2), `${(100 * one.covered).toFixed(0)} %`] : [why, '-', '-']),
    ];
  });
  return `Drawn by three.js in Chromium, 512 x 512 pixels, one camera and light, the same ID (key 1) by every scheme; the pictures are in the
report. Differences are levels of 255, of each pixel the largest of its three channels; the mean is over the pixels that the model covers.

${tableOf(['model', 'scheme', 'settings', 'largest', 'mean', 'covered'], rows)}`;
}
