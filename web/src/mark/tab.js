// SPDX-License-Identifier: MIT
// The tab that marks: a model, what to hide, a key; then the marked file.
import { $, segments, showSentences } from '../dom.js';
import { Engine } from '../engine.js';
import { openArchives } from '../files/archives.js';
import { itemsOfInput } from '../files/items.js';
import { baseName } from '../files/paths.js';
import { sortItems, splitStrangers } from '../files/sort.js';
import { passphraseForm } from '../passphrase.js';
import { sizeWords, t, wholeWords } from '../words/language.js';
import { panels, showResult } from './outcome.js';
import { PayloadForm } from './payload.js';

// How many labels a payload takes, measured on 16 models: IDs from about 230, pictures from about 1000, and those up to
// half as many pixels as there are labels (the sparest model took 2.8 labels a pixel, others 1 to 2).
const LABELS_FOR_ID = 230, LABELS_FOR_PICTURE = 1000, LABELS_PER_PIXEL = 2;
const KEY_KINDS = [['new', 'keyNew'], ['load', 'keyLoad'], ['phrase', 'keyPhrase']];

const engine = new Engine();    // marks
const measurer = new Engine();  // inspects, meanwhile
const given = { model: null, parts: [], keyFile: null, derived: null };
let keyKind = 'new';
let room = null;   // of inspect()
let redraw = () => panels.idle(t('markIdle'));

const showNotices = (sentences) => showSentences($('mark-notices'), sentences);
const payload = new PayloadForm(() => update(), (sentence) => showNotices([sentence]));
const told = ({ path, file }) => `${baseName(path)} (${sizeWords(file.size)})`;

function keyRequest() {
  if (keyKind === 'new') return { owner: $('owner-input').value.trim() };
  if (keyKind === 'phrase') return given.derived ? { key: given.derived.key } : null;
  return given.keyFile ? { file: given.keyFile.file } : null;
}

/** Longer side of the largest picture that fits well; 0 where none does. */
const roomSide = ({ robust: { labels } }) => (labels < LABELS_FOR_PICTURE ? 0 : Math.min(128, Math.floor(Math.sqrt(labels / LABELS_PER_PIXEL))));

function showRoom() {
  if (!room) return;
  const side = roomSide(room);
  const fits = side > 0 ? t('roomPicture', side) : t(room.robust.labels < LABELS_FOR_ID ? 'roomNone' : 'roomId');
  const words = `${t('room', { vertices: wholeWords(room.vertices), places: wholeWords(room.robust.carriers) })} ${fits}`;
  $('room').textContent = payload.side > side ? `${words} ${t('roomTight')}` : words;
}

/** Shows what is there and what is still needed. */
function update() {
  const extra = given.parts.length > 0 ? t('moreFiles', given.parts.length) : '';
  $('mark-model-file').textContent = given.model ? told(given.model) + extra : t('markModelHint');
  $('mark-key-file').textContent = given.keyFile ? told(given.keyFile) : t('keyHint');
  for (const [id, item] of [['mark-model-file', given.model], ['mark-key-file', given.keyFile]]) $(id).closest('.slot').classList.toggle('filled', Boolean(item));
  showRoom();
  const needs = [];
  if (!given.model) needs.push(t('needModel'));
  if (typeof payload.value === 'string') needs.push(t(payload.value));
  if (!keyRequest()) needs.push(t('needKey'));
  $('mark-button').disabled = needs.length > 0;
  $('mark-needs').textContent = needs.length > 0 ? t('markNeeds', needs.join(', ')) : '';
}

const namesNow = () => ({ model: baseName(given.model.path), key: given.keyFile ? baseName(given.keyFile.path) : t('key'), logo: payload.name, reference: payload.name });

async function measure() {
  room = null;
  $('room').textContent = t('measuring');
  const answer = await measurer.run({ job: 'inspect', model: given.model, parts: given.parts }).catch(() => null);
  if (answer === null) return;  // another model came
  $('room').textContent = '';
  if (answer.type === 'result') {
    room = answer.report;
    payload.propose(roomSide(room));
    panels.idle(t('markIdle'));
  } else {
    panels.problem(answer, namesNow());
  }
  redraw = answer.type === 'result' ? () => panels.idle(t('markIdle')) : () => panels.problem(answer, namesNow());
  update();
}

async function setModel(model, parts) {
  engine.cancel();
  Object.assign(given, { model, parts });
  update();
  await measure();
}

/** Takes files in whose kind is found by looking at them; a picture is what to hide. */
export async function take(dropped) {
  if (dropped.length === 0) return;
  const { items, notices: unpacking } = await openArchives(dropped);
  const pictures = items.filter(({ file }) => /\.(svg|jpe?g)$/i.test(file.name) || file.type === 'image/svg+xml' || file.type === 'image/jpeg');
  const sorted = await sortItems(items.filter((item) => !pictures.includes(item)));
  const { parts, notices: strangers } = splitStrangers(sorted.parts, sorted.models);
  const notices = [...unpacking, ...sorted.notices, ...strangers];
  if (sorted.models.length > 1) notices.push(t('severalAtOnce', { n: sorted.models.length, what: t('modelFiles'), names: sorted.models.map(({ path }) => path).join(', ') }));
  showNotices(notices);
  const logo = sorted.reference ?? pictures[0];
  if (sorted.key) {
    given.keyFile = sorted.key;
    $('key-kinds').querySelector('input[value="load"]').click();
  }
  if (logo && (sorted.models.length === 0 || logo === sorted.reference)) await payload.take(logo.file);
  if (sorted.models.length === 1) await setModel(sorted.models[0], given.model ? parts : [...given.parts, ...parts]);
  else if (parts.length > 0) {
    given.parts.push(...parts);
    if (given.model) await measure();
  }
  update();
}

async function mark() {
  const request = {
    job: 'mark', model: given.model, parts: given.parts, key: keyRequest(), payload: payload.value,
    strength: $('strength').value, salt: $('mark-salt-input').value.trim(),
  };
  if (!request.model || typeof request.payload === 'string' || !request.key) return;
  const names = namesNow();
  panels.working(names.model);
  panels.bringIntoSight();
  let answer;
  try {
    answer = await engine.run(request, (progress) => panels.progress(progress));
  } catch (error) {
    if (error.name === 'AbortError') return;
    throw error;
  }
  const draw = (options) => (answer.type === 'result' ? showResult(answer, request, options) : panels.problem(answer, names));
  draw();
  redraw = () => draw({ spoken: false });
}

/** Says what was wrong with a drop. */
export const complain = (sentence) => showNotices([sentence]);

/** Writes everything in the language of now. */
export function refresh() {
  payload.refresh();
  update();
  redraw();
}

$('key-kinds').append(segments('key-kind', 'keyKind', KEY_KINDS, 'new', (kind) => {
  keyKind = kind;
  for (const [name] of KEY_KINDS) $(`key-${name}`).hidden = name !== kind;
  update();
}));
passphraseForm($('key-phrase'), 'mark', (derived) => {
  given.derived = derived;
  update();
  $('mark-button').focus();
});
$('mark-model-input').addEventListener('change', async ({ target }) => {
  const items = itemsOfInput(target);
  target.value = '';
  if (items.length === 1 && !/\.(bin|zip)$/i.test(items[0].path)) await setModel(items[0], []);
  else await take(items);
});
$('mark-key-input').addEventListener('change', ({ target }) => {
  const [item] = itemsOfInput(target);
  target.value = '';
  if (item) given.keyFile = item;
  update();
});
$('mark-form').addEventListener('submit', (event) => {
  event.preventDefault();
  mark();
});
$('mark-cancel').addEventListener('click', () => {
  engine.cancel();
  panels.idle(t('markCancelled'), { spoken: true });
  redraw = () => panels.idle(t('markIdle'));
  $('mark-button').focus();
});
