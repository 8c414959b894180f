// SPDX-License-Identifier: MIT
// The result of the marking tab. Only writes to the document.
import { $, announce, element, showFacts, showSentences, Urls } from '../dom.js';
import { baseName, stemOf } from '../files/paths.js';
import { Panels } from '../panels.js';
import { markingRecord } from '../report/record.js';
import { ViewPanel } from '../view3d/panel.js';
import { hasText, scientific, secondsWords, t, tenthWords, wholeWords } from '../words/language.js';
import { oneInSpoken } from '../words/odds.js';

const urls = new Urls();
const view = new ViewPanel($('compare'));
export const panels = new Panels('mark-', 'marking', view);

// In texels where the image is known, otherwise as a share of the texture.
const textureWords = ({ uv, texels }) => (texels === null ? scientific(uv) : t('texels', tenthWords(texels)));

function factsOf({ report, millis, inputs, outputs }) {
  const { distortion } = report;
  const share = (value) => scientific(value);
  return [
    ...(hasText(`class_${report.capacityClass}`) ? [[t('factClass'), t(`class_${report.capacityClass}`)]] : []),
    [t('factRepeats'), tenthWords(report.repeats)],
    [t('factRms'), share(distortion.rmsRel)],
    [t('factMax'), share(distortion.maxRel)],
    [t('factHausdorff'), share(distortion.hausdorffRel)],
    [t('factSnr'), t('decibels', tenthWords(distortion.snrDb))],
    [t('factNormals'), t('degrees', tenthWords(distortion.meanNormalDeg))],
    ...(report.textureShift ? [[t('factTexture'), textureWords(report.textureShift)]] : []),
    [t('factBytes'), wholeWords(report.bytesChanged)],
    [t('factTime'), secondsWords(millis)],
    [t('factHash', inputs.model.name), inputs.model.sha256],
    [t('factHash', `${outputs.model.name} (${t('sampleMarked').toLowerCase()})`), outputs.model.sha256],
  ];
}

function showSaves(result, { stem, extension }, request) {
  const link = (text, content, type, name) => element('a', { class: 'button', href: urls.of(content, type), download: name, 'data-t': text }, t(text));
  const model = link('saveModel', result.bytes, 'application/octet-stream', `${stem}.marked${extension}`);
  model.classList.add('strong');
  model.id = 'save-model';
  const key = link('saveKey', result.key, 'application/json', `${stem}.key.json`);
  key.id = 'save-key';
  const record = `${JSON.stringify(markingRecord(result, request, new Date()), null, 2)}\n`;
  const report = link('saveRecord', record, 'application/json', `${stem}.marking.json`);
  report.id = 'save-record';
  const buffers = result.resources.map(({ name, bytes }) => element('a', { class: 'button', href: urls.of(bytes, 'application/octet-stream'), download: name }, name));
  $('mark-saves').replaceChildren(model, ...buffers, key, report);
}

/** @param request  what was asked of the worker */
export function showResult(result, request, { spoken = true } = {}) {
  urls.revoke();
  const { model, parts } = request;
  const name = baseName(model.path);
  const { verified } = result.report;
  $('mark-proof').textContent = verified?.falsePositive === undefined ? name : t('markProof', oneInSpoken(verified.falsePositive));
  showSaves(result, { stem: stemOf(name), extension: /\.[^.]*$/.exec(name)?.[0] ?? '' }, request);
  showFacts($('mark-facts'), factsOf(result));
  showSentences($('mark-warnings'), result.report.warnings);
  $('mark-warnings').hidden = result.report.warnings.length === 0;
  panels.show('result', 'done');
  const changed = new Map(result.resources.map((file) => [file.name, file.bytes]));
  const after = {
    model: { path: model.path, file: new File([result.bytes], name) },
    parts: parts.map((part) => (changed.has(baseName(part.path)) ? { path: part.path, file: new File([changed.get(baseName(part.path))], part.file.name) } : part)),
  };
  view.offer({ kind: 'compare', model, parts, after });
  if (!spoken) return;
  $('mark-verdict').focus({ preventScroll: true });
  panels.bringIntoSight();
  announce(`${t('markDone')} ${$('mark-proof').textContent} ${t('keepKey')}`);
}
