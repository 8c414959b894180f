// SPDX-License-Identifier: MIT
// The right-hand side of the page: idle, working, problem or result. Only writes to the document.
import { missingWords, oneIn, oneInSpoken, percent, problemWords, stageWords, verdictWords, whole } from './words.js';

const $ = (id) => document.getElementById(id);
const PANELS = ['idle', 'working', 'problem', 'result'];

/** Object URLs shown now; given back when the next result comes. */
let urls = [];
let ticking = null;

function urlOf(content, type) {
  const url = URL.createObjectURL(new Blob([content], { type }));
  urls.push(url);
  return url;
}

function show(panel, state = panel) {
  for (const name of PANELS) $(name).hidden = name !== panel;
  $('outcome').dataset.state = state;
  $('outcome').setAttribute('aria-busy', String(panel === 'working'));
  clearInterval(ticking);
}

/** Says it to screen readers, the same words again included. */
function announce(text) {
  $('announcer').textContent = '';
  requestAnimationFrame(() => { $('announcer').textContent = text; });
}

export function showIdle(text, { spoken = false } = {}) {
  $('idle-text').textContent = text;
  if (spoken) announce(text);
  show('idle');
}

export function showWorking(modelName) {
  $('working-name').textContent = modelName;
  const started = performance.now();
  const tick = () => {
    const seconds = Math.floor((performance.now() - started) / 1000);
    $('elapsed').textContent = seconds > 0 ? `${seconds} s` : '';
  };
  show('working');
  tick();
  ticking = setInterval(tick, 250);
  showProgress({ stage: 'load', done: 0 });
  announce(`Checking ${modelName}`);
}

export function showProgress({ stage, done }) {
  $('progress').value = done;
  $('progress').dataset.stage = stage;
  $('stage').textContent = `${stageWords(stage)} …`;
}

function showSentences({ title, text, hint }, state) {
  $('problem-title').textContent = title;
  $('problem-text').textContent = text;
  $('problem-hint').textContent = hint;
  announce([title, text, hint].join(' '));
  show('problem', state);
}

export const showProblem = (problem, names) => showSentences(problemWords(problem, names), 'problem');
export const showMissing = (uris, modelName) => showSentences(missingWords(uris, modelName), 'missing');

/** "1 in 10^23" for the eye, "to the power of" for the ear. */
function showOdds(falsePositive) {
  const value = oneIn(falsePositive);
  $('odds-label').textContent = value ? 'False-alarm probability, at most' : 'Agreement with this key';
  const eye = document.createElement('span'), ear = document.createElement('span');
  eye.setAttribute('aria-hidden', 'true');
  eye.textContent = value?.text ?? 'No better than chance';
  if (value && value.exponent !== null) {
    const power = document.createElement('sup');
    power.textContent = value.exponent;
    eye.append(power);
  }
  ear.className = 'visually-hidden';
  ear.textContent = oneInSpoken(falsePositive);
  $('odds').replaceChildren(eye, ear);
}

function picture(id, png, alt) {
  const image = $(id);
  image.src = urlOf(png, 'image/png');
  image.alt = alt;
}

const pixels = (n) => `${whole(n)} ${n === 1 ? 'pixel' : 'pixels'}`;
const countOnes = (bits) => bits.reduce((sum, bit) => sum + bit, 0);

/** Pixels that were read, and read otherwise than the reference has them. */
function differing(image, reference) {
  let n = 0;
  image.bits.forEach((bit, i) => { if (!image.erased[i] && bit !== reference.bits[i]) ++n; });
  return n;
}

function showPictures(result) {
  const { image, reference, verdict, isId } = result;
  if (image === null) {  // an ID, a text, or nothing, under a key that does not say which
    for (const id of ['image-figure', 'confidence-figure', 'reference-figure']) $(id).hidden = true;
    return;
  }
  const unread = countOnes(image.erased);
  const size = `${image.width} by ${image.height} pixels`;
  $('pictures').classList.toggle('of-id', isId);
  $('image-figure').hidden = isId;
  // The confidence is that of a mark which is there: beside noise it would claim a certainty that nothing has.
  const each = isId ? 'bit' : 'pixel';
  const none = verdict === 'none';
  $('confidence-figure').hidden = none;
  $('confidence-title').textContent = `How sure each ${each} is`;
  $('confidence-caption').textContent = `${percent(result.averageConfidence)} on average`;
  picture('confidence', image.confidencePng, `Confidence per ${each}, white is certain; ${percent(result.averageConfidence)} on average`);
  if (!isId) {
    picture('image', image.png, none ? `What this key reads without a mark, ${size}` : `The extracted picture, ${size}`);
    const left = unread > 0 ? `; ${pixels(unread)} could not be read (grey)` : '';
    $('image-caption').textContent = none ? 'shows noise; grey pixels could not be read.' : `${image.width} × ${image.height}${left}`;
  }
  $('reference-figure').hidden = !reference || isId;
  $('pictures').classList.toggle('with-reference', Boolean(reference) && !isId);
  if (reference && !isId) {
    picture('reference', reference.png, `Your reference, ${size}`);
    const wrong = differing(image, reference);
    $('reference-caption').textContent = wrong === 0 && unread === 0
      ? 'is the same in every pixel'
      : `differs in ${pixels(wrong)} of the ${whole(image.bits.length - unread)} that were read`;
  }
}

function showFacts(result) {
  const { report, image } = result;
  const facts = [
    ['Key made for', result.owner || 'nobody in particular'],
    ['Cells that carry the reading', whole(report.cells)],
    ...(report.piecesRead === undefined ? [] : [['Pieces read', whole(report.piecesRead)]]),
    ...(image === null ? [] : [['Pixels not read', `${whole(countOnes(image.erased))} of ${whole(image.bits.length)}`]]),
    ...(result.verdict === 'none' || image === null ? [] : [['Average confidence', percent(result.averageConfidence)]]),
    ...(report.ber === undefined ? [] : [['Wrong bits against the reference', percent(report.ber)]]),
    ['False-positive probability, at most', result.falsePositive.toExponential(2)],
    ['Time', `${(result.millis / 1000).toFixed(2)} s`],
  ];
  $('facts').replaceChildren(...facts.flatMap(([name, value]) => {
    const term = document.createElement('dt'), description = document.createElement('dd');
    term.textContent = name;
    description.textContent = value;
    return [term, description];
  }));
}

/** @param names  file name by "model", "key", "reference" */
export function showResult(result, names) {
  for (const url of urls) URL.revokeObjectURL(url);
  urls = [];
  const words = verdictWords(result);
  $('verdict').dataset.verdict = result.verdict;
  $('verdict-label').textContent = words.label;
  $('verdict-title').textContent = words.title;
  $('verdict-files').textContent = [names.model, names.key, result.owner && `key of ${result.owner}`].filter(Boolean).join(' · ');
  showOdds(result.falsePositive);
  $('odds-meaning').textContent = words.meaning;
  const found = result.id ?? result.text;
  $('found-id').hidden = found === null;
  $('id-text').textContent = found ?? '';
  showPictures(result);
  showFacts(result);
  $('warnings').replaceChildren(...result.report.warnings.map((warning) => {
    const item = document.createElement('li');
    item.textContent = warning;
    return item;
  }));
  $('warnings').hidden = result.report.warnings.length === 0;

  const stem = names.model.replace(/\.[^.]*$/, '');
  $('save-image').hidden = result.isId;
  if (result.image !== null) $('save-image').href = urlOf(result.image.png, 'image/png');
  $('save-image').download = `${stem}.mark.png`;
  $('save-report').href = urlOf(`${JSON.stringify(result.report, null, 2)}\n`, 'application/json');
  $('save-report').download = `${stem}.report.json`;
  show('result', result.verdict);
  announce(`${words.label}: ${words.title} ${$('odds-label').textContent}: ${oneInSpoken(result.falsePositive)}.`);
}
