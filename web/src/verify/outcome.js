// SPDX-License-Identifier: MIT
// The result of the verifying tab. Only writes to the document.
import { $, announce, element, showFacts, showSentences, Urls } from '../dom.js';
import { baseName, stemOf } from '../files/paths.js';
import { Panels } from '../panels.js';
import { verificationRecord } from '../report/record.js';
import { ViewPanel } from '../view3d/panel.js';
import { currentLanguage, hasText, percent, scientific, secondsWords, t, wholeWords } from '../words/language.js';
import { oneIn, oneInSpoken, verdictWords } from '../words/odds.js';
import { countOnes, showPictures } from './pictures.js';

const urls = new Urls();
const view = new ViewPanel($('view'));
export const panels = new Panels('', 'checking', view);

/** "1 in 10^23" for the eye, "to the power of" for the ear. */
export function oddsElements(falsePositive) {
  const value = oneIn(falsePositive);
  const eye = element('span', { 'aria-hidden': 'true' }, value?.text ?? t('noRarity'));
  if (value && value.exponent !== null) eye.append(element('sup', {}, String(value.exponent)));
  return [eye, element('span', { class: 'visually-hidden' }, oneInSpoken(falsePositive))];
}

function factsOf(result) {
  const { report, image, inputs, verdict } = result;
  const known = (name, value) => (value === undefined || value === null ? [] : [[t(name), value]]);
  return [
    [t('factOwner'), inputs.key.owner || t('nobody')],
    [t('factScheme'), report.scheme],
    [t('factCells'), wholeWords(report.cells)],
    ...known('factPieces', report.piecesRead === undefined ? null : wholeWords(report.piecesRead)),
    ...(image === null ? [] : [[t('factUnread'), t('ofAll', { n: wholeWords(countOnes(image.erased)), all: wholeWords(image.bits.length) })]]),
    ...(verdict === 'none' || image === null ? [] : [[t('factConfidence'), percent(result.averageConfidence)]]),
    ...known('factBer', report.ber === undefined ? null : percent(report.ber)),
    ...known('factStrength', hasText(`strength_${report.strength}`) ? t(`strength_${report.strength}`) : null),
    [t('factOdds'), scientific(result.falsePositive)],
    ...known('factVertices', report.readFromVertices === undefined ? null : wholeWords(report.readFromVertices)),
    ...known('factHypotheses', report.hypotheses === undefined ? null : wholeWords(report.hypotheses)),
    [t('factTime'), secondsWords(result.millis)],
    ...[inputs.model, ...inputs.resources, inputs.key, inputs.reference].filter((file) => file?.sha256)
      .map(({ name, sha256 }) => [t('factHash', name), sha256]),
  ];
}

function showNodes({ report, verdict }) {
  const nodes = (report.perNode ?? []).filter(({ cells }) => cells > 0);
  $('nodes').hidden = verdict === 'none' || nodes.length === 0;
  $('node-rows').replaceChildren(...nodes.sort((a, b) => b.share - a.share).slice(0, 50).map(({ node, name, cells, share }) => element('tr', {},
    element('td', {}, name || t('unnamed', node)),
    element('td', {}, element('meter', { min: 0, max: 1, value: share, 'aria-hidden': 'true' }), ` ${percent(share)}`),
    element('td', {}, wholeWords(cells)))));
}

/**
 * @param names  file name by "model", "key", "reference"
 * @param model  { model: Item, parts: Item[] } for the 3D view
 */
export function showResult(result, names, model, { spoken = true } = {}) {
  urls.revoke();
  const { verdict, falsePositive, inputs } = result;
  const words = verdictWords(result);
  $('verdict').dataset.verdict = verdict;
  $('verdict-label').textContent = words.label;
  $('verdict-title').textContent = words.title;
  $('verdict-files').textContent = [names.model, names.key, inputs.key.owner && t('keyOf', inputs.key.owner)].filter(Boolean).join(' · ');
  $('odds-label').textContent = t(oneIn(falsePositive) ? 'oddsLabel' : 'oddsLabelNone');
  $('odds').replaceChildren(...oddsElements(falsePositive));
  $('odds-meaning').textContent = words.meaning;
  const found = result.id ?? result.text;
  $('found-id').hidden = found === null;
  $('found-label').textContent = t(result.id === null ? 'hiddenText' : 'hiddenId');
  $('id-text').textContent = found ?? '';
  showPictures(result, urls);
  showFacts($('facts'), factsOf(result));
  showSentences($('warnings'), result.report.warnings);
  $('warnings').hidden = result.report.warnings.length === 0;
  showNodes(result);

  const stem = stemOf(names.model);
  const record = verificationRecord(result, new Date());
  $('save-image').hidden = result.isId;
  if (result.image !== null) $('save-image').href = urls.of(result.image.png, 'image/png');
  $('save-image').download = `${stem}.mark.png`;
  $('save-report').href = urls.of(`${JSON.stringify(record, null, 2)}\n`, 'application/json');
  $('save-report').download = `${stem}.report.json`;
  const date = new Date(record.made).toLocaleString(currentLanguage() === 'de' ? 'de-DE' : 'en-GB', { dateStyle: 'long', timeStyle: 'short' });
  $('print-made').textContent = t('printMade', { date, version: result.toolVersion });
  panels.show('result', verdict);
  view.offer({ kind: 'evidence', name: baseName(model.model.path), ...model, evidence: verdict === 'none' ? new Float32Array() : result.evidence });
  if (!spoken) return;
  $('verdict').focus({ preventScroll: true });
  panels.bringIntoSight();
  announce(`${words.label}: ${words.title} ${$('odds-label').textContent}: ${oneInSpoken(falsePositive)}.`);
}
