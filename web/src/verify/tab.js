// SPDX-License-Identifier: MIT
// The tab that verifies: files go into slots; as soon as there are models and a key, they are checked one after another.
import { $, announce, element, showSentences } from '../dom.js';
import { Engine } from '../engine.js';
import { openArchives } from '../files/archives.js';
import { itemsOfInput } from '../files/items.js';
import { baseName } from '../files/paths.js';
import { sortItems, splitStrangers } from '../files/sort.js';
import { passphraseForm } from '../passphrase.js';
import { openSample } from '../platform/served.js';
import { sizeWords, t } from '../words/language.js';
import { panels, showResult } from './outcome.js';
import { showQueue } from './queue.js';

const SLOTS = ['model', 'key', 'reference'];
const engine = new Engine();

/** What is in the slots. key: { item } or { key, label } from a passphrase; parts: files that a glTF may need. */
const given = { models: [], key: null, reference: null, parts: [] };
/** The run that is shown: its entries, which one is picked (null: the one that is being checked), and who may go on. */
let run = { entries: [], picked: null };
/** How to write the outcome again in another language. */
let redraw = () => panels.idle(waitingWords());

const keyName = () => (given.key ? given.key.label ?? baseName(given.key.item.path) : '');
const namesFor = (model) => ({ model: baseName(model.path), key: keyName(), reference: given.reference ? baseName(given.reference.path) : '' });
const told = ({ path, file }) => `${baseName(path)} (${sizeWords(file.size)})`;

function modelLine() {
  const more = given.parts.length > 0 ? t('moreFiles', given.parts.length) : '';
  const bytes = given.models.reduce((sum, { file }) => sum + file.size, 0);
  return given.models.length === 1 ? told(given.models[0]) + more : `${t('severalModels', given.models.length)} (${sizeWords(bytes)})${more}`;
}

function showSlots() {
  const lines = {
    model: given.models.length > 0 ? modelLine() : null,
    key: given.key ? given.key.label ?? told(given.key.item) : null,
    reference: given.reference ? told(given.reference) : null,
  };
  for (const slot of SLOTS) {
    const place = document.querySelector(`[data-slot="${slot}"]`);
    place.classList.toggle('filled', lines[slot] !== null);
    place.querySelector('[data-clear]').hidden = lines[slot] === null;
    $(`${slot}-file`).textContent = lines[slot] ?? t(`${slot}Hint`);
  }
  $('check').disabled = given.models.length === 0 || !given.key;
}

const showNotices = (sentences) => showSentences($('notices'), sentences);

function waitingWords() {
  if (given.models.length > 0 && !given.key) return t('waitKey');
  if (given.key && given.models.length === 0) return t('waitModel');
  if (given.reference) return t('waitBoth');
  if (given.parts.length > 0) return t('waitGltf', baseName(given.parts[0].path));
  return t('idle');
}

function showEntry({ model, answer }, options) {
  if (answer.type === 'result') showResult(answer, namesFor(model), { model, parts: given.parts }, options);
  else panels.problem(answer, namesFor(model));
  redraw = () => showEntry({ model, answer }, { spoken: false });
}

function updateQueue() {
  const { entries } = run;
  showQueue(entries, run.picked, (index) => {
    run.picked = index;
    updateQueue();
    showEntry(entries[index]);
  });
}

function showWaiting(text, options) {
  panels.idle(text, options);
  redraw = () => panels.idle(waitingWords());
}

/** Checks everything anew with what the slots hold now. */
async function check() {
  engine.cancel();
  const now = run = { entries: [], picked: null };
  updateQueue();
  if (given.models.length === 0 || !given.key) {
    showWaiting(waitingWords(), { spoken: true });
    return;
  }
  now.entries = given.models.map((model) => ({ model, state: 'queued' }));
  panels.bringIntoSight();
  const many = now.entries.length > 1;
  for (const entry of now.entries) {
    entry.state = 'working';
    updateQueue();
    const watched = () => now.picked === null;
    if (watched()) panels.working(baseName(entry.model.path));
    redraw = () => panels.working(baseName(entry.model.path));
    try {
      entry.answer = await engine.run({
        job: 'verify', model: entry.model, parts: given.parts, reference: given.reference?.file ?? null, salt: $('salt-input').value.trim(),
        key: given.key.key ? { key: given.key.key } : { file: given.key.item.file },
      }, (progress) => { if (watched()) panels.progress(progress); });
    } catch (error) {
      if (error.name === 'AbortError') return;  // whoever cancelled shows what comes next
      throw error;
    }
    entry.state = 'done';
    updateQueue();
    if (!many) showEntry(entry);
  }
  if (!many) return;
  const matches = now.entries.filter(({ answer }) => answer.verdict === 'match').length;
  if (now.picked === null) {
    now.picked = 0;
    updateQueue();
    showEntry(now.entries[0]);
  }
  announce(t('queueDone', { match: matches, all: now.entries.length }));
}

/** Takes files in whose kind is found by looking at them. */
export async function take(dropped) {
  if (dropped.length === 0) return;
  const { items, notices: unpacking } = await openArchives(dropped);
  const { models, key, reference, parts: others, notices } = await sortItems(items);
  const { parts, notices: strangers } = splitStrangers(others, models);
  if (models.length > 0) {
    // Buffers that came before their glTF stay; those of other models go.
    given.parts = given.models.length > 0 ? parts : [...given.parts, ...parts];
    given.models = models;
  } else {
    given.parts.push(...parts);
  }
  given.key = key ? { item: key } : given.key;
  given.reference = reference ?? given.reference;
  showNotices([...unpacking, ...notices, ...strangers]);
  showSlots();
  if (models.length > 0 || key || reference || parts.length > 0) await check();
}

/** Puts a file into a slot, whatever it looks like; reading it says what is wrong. */
async function put(slot, item) {
  showNotices([]);
  if (slot === 'model') Object.assign(given, { models: [item], parts: [] });
  else given[slot] = slot === 'key' ? { item } : item;
  showSlots();
  await check();
}

const SAMPLES = { marked: ['marked.glb', 'key.json'], damaged: ['damaged.glb', 'key.json'], unmarked: ['unmarked.glb', 'key.json'], wrong: ['marked.glb', 'wrong-key.json'] };

async function takeSample(name) {
  try {
    const [model, key, reference] = await Promise.all([...SAMPLES[name], 'logo.png'].map(async (file) => ({ path: file, file: await openSample(file) })));
    Object.assign(given, { models: [model], key: { item: key }, reference, parts: [] });
  } catch (error) {
    showNotices([t('sampleFailed', error.message)]);
    return;
  }
  showNotices([]);
  showSlots();
  await check();
}

/** Says what was wrong with a drop. */
export const complain = (sentence) => showNotices([sentence]);

/** Writes everything in the language of now. */
export function refresh() {
  showSlots();
  updateQueue();
  redraw();
}

// The same file chosen again must count as a change: hence the emptied value.
$('model-input').addEventListener('change', async ({ target }) => {
  const items = itemsOfInput(target);
  target.value = '';
  // Several files are models and what belongs to them; a single one that looks like no model is read as one all the same.
  const only = items.length === 1 && !/\.(bin|zip)$/i.test(items[0].path);
  if (only) await put('model', items[0]);
  else await take(items);
});
$('folder-input').addEventListener('change', async ({ target }) => {
  const items = itemsOfInput(target);
  target.value = '';
  await take(items);
});
for (const slot of ['key', 'reference']) {
  $(`${slot}-input`).addEventListener('change', async ({ target }) => {
    const [item] = itemsOfInput(target);
    target.value = '';
    if (item) await put(slot, item);
  });
}
for (const button of document.querySelectorAll('[data-clear]')) {
  button.addEventListener('click', () => {
    const slot = button.dataset.clear;
    if (slot === 'model') Object.assign(given, { models: [], parts: [] });
    else given[slot] = null;
    showNotices([]);
    showSlots();
    $(`${slot}-input`).focus();
    check();
  });
}
for (const button of document.querySelectorAll('[data-sample]')) {
  button.addEventListener('click', () => takeSample(button.dataset.sample));
}
$('passphrase').append(element('summary', { 'data-t': 'usePassphrase' }));
passphraseForm($('passphrase'), 'verify', async ({ key, label }) => {
  given.key = { key, label };
  $('passphrase').open = false;
  showSlots();
  await check();
});
$('check').addEventListener('click', () => check());
$('salt-input').addEventListener('change', () => check());
$('print').addEventListener('click', () => print());
$('cancel').addEventListener('click', () => {
  engine.cancel();
  for (const entry of run.entries) if (entry.state !== 'done') entry.state = 'skipped';
  updateQueue();
  showWaiting(t('cancelled'), { spoken: true });
  $('check').focus();
});
