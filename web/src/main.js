// SPDX-License-Identifier: MIT
// Wires the page: files go into three slots; as soon as there are a model and a key, the detector checks them.
import { Detector } from './detector.js';
import { baseName, itemsOfDrop, itemsOfInput, sortItems, splitStrangers } from './files.js';
import { showIdle, showMissing, showProblem, showProgress, showResult, showWorking } from './outcome_view.js';
import { sizeWords } from './words.js';

const $ = (id) => document.getElementById(id);
const SLOTS = ['model', 'key', 'reference'];
const HINTS = Object.fromEntries(SLOTS.map((slot) => [slot, $(`${slot}-file`).cloneNode(true)]));

const detector = new Detector();
/** What is in the slots, each an Item or null; parts: files that a glTF may need. */
const given = { model: null, key: null, reference: null, parts: [] };

function names() {
  return Object.fromEntries(SLOTS.map((slot) => [slot, given[slot] ? baseName(given[slot].path) : '']));
}

function showSlots() {
  for (const slot of SLOTS) {
    const item = given[slot];
    const element = document.querySelector(`[data-slot="${slot}"]`);
    element.classList.toggle('filled', item !== null);
    element.querySelector('[data-clear]').hidden = item === null;
    const line = $(`${slot}-file`);
    if (!item) {
      line.replaceChildren(...HINTS[slot].cloneNode(true).childNodes);
      continue;
    }
    const more = slot === 'model' && given.parts.length > 0 ? ` + ${given.parts.length} more` : '';
    line.textContent = `${baseName(item.path)} (${sizeWords(item.file.size)})${more}`;
  }
  $('check').disabled = !(given.model && given.key);
}

function showNotices(sentences) {
  $('notices').replaceChildren(...sentences.map((text) => {
    const line = document.createElement('li');
    line.textContent = text;
    return line;
  }));
}

function waitingWords() {
  if (given.model && !given.key) return 'The model is here. Now add the key file.';
  if (given.key && !given.model) return 'The key is here. Now add the model.';
  if (given.reference) return 'The reference is here. Now add the model and the key file.';
  if (given.parts.length > 0) return `${baseName(given.parts[0].path)} is here. Now add the .gltf file it belongs to, and the key file.`;
  return 'The verdict and the hidden picture appear here as soon as a model and a key are there.';
}

/** Starts over with what the slots hold now. */
async function check() {
  detector.cancel();
  if (!given.model || !given.key) {
    showIdle(waitingWords(), { spoken: true });
    return;
  }
  const at = names();
  showWorking(at.model);
  if (matchMedia('(max-width: 56rem)').matches) $('outcome').scrollIntoView({ block: 'start' });
  let answer;
  try {
    answer = await detector.check({
      model: given.model, key: given.key.file, reference: given.reference?.file ?? null, parts: given.parts,
    }, showProgress);
  } catch (error) {
    if (error.name === 'AbortError') return;  // whoever cancelled shows what comes next
    throw error;
  }
  if (answer.type === 'result') showResult(answer, at);
  else if (answer.type === 'missing') showMissing(answer.uris, at.model);
  else showProblem(answer, at);
}

/** Takes files in whose kind is found by looking at them. */
async function take(items) {
  if (items.length === 0) return;
  const { model, key, reference, parts: others, notices } = await sortItems(items);
  const { parts, notices: strangers } = splitStrangers(others, model);
  if (model) {
    // Buffers that came before their glTF stay; those of another model go.
    given.parts = given.model ? parts : [...given.parts, ...parts];
    given.model = model;
  } else {
    given.parts.push(...parts);
  }
  given.key = key ?? given.key;
  given.reference = reference ?? given.reference;
  showNotices([...notices, ...strangers]);
  showSlots();
  if (model || key || reference || parts.length > 0) await check();
}

/** Puts the first chosen file into a slot, whatever it looks like; reading it says what is wrong. */
async function put(slot, items) {
  if (items.length === 0) return;
  showNotices([]);
  [given[slot]] = items;
  showSlots();
  await check();
}

async function takeDrop(transfer) {
  let items;
  try {
    items = await itemsOfDrop(transfer);
  } catch (error) {
    showNotices([`The dropped folder could not be read: ${error.message}.`]);
    return;
  }
  if (items.length === 0) showNotices(['There was no file in what you dropped.']);
  await take(items);
}

async function takeSample(name) {
  const files = [`${name}.glb`, 'key.json', 'logo.png'];
  try {
    const [model, key, reference] = await Promise.all(files.map(async (file) => {
      const response = await fetch(`./sample/${file}`);
      if (!response.ok) throw new Error(`${file}: HTTP status ${response.status}`);
      return { path: file, file: new File([await response.arrayBuffer()], file) };
    }));
    Object.assign(given, { model, key, reference, parts: [] });
  } catch (error) {
    showNotices([`The sample could not be loaded (${error.message}).`]);
    return;
  }
  showNotices([]);
  showSlots();
  await check();
}

// Drops land anywhere on the page. The veil counts enters and leaves: each child under the pointer sends its own.
let depth = 0;
const carriesFiles = (event) => [...(event.dataTransfer?.types ?? [])].includes('Files');
const lower = () => {
  depth = 0;
  $('veil').hidden = true;
};
addEventListener('dragenter', (event) => {
  if (!carriesFiles(event)) return;
  event.preventDefault();
  ++depth;
  $('veil').hidden = false;
});
addEventListener('dragover', (event) => {
  if (!carriesFiles(event)) return;
  event.preventDefault();
  event.dataTransfer.dropEffect = 'copy';
});
addEventListener('dragleave', (event) => {
  if (carriesFiles(event) && --depth <= 0) lower();
});
addEventListener('drop', (event) => {
  event.preventDefault();
  lower();
  if (carriesFiles(event)) takeDrop(event.dataTransfer);
  else showNotices(['That was no file. Drop a model (GLB, glTF, PLY, DRC) and a key file.']);
});

// The same file chosen again must count as a change: hence the emptied value.
$('model-input').addEventListener('change', async ({ target }) => {
  const items = itemsOfInput(target);
  target.value = '';
  // Several files are a glTF and what belongs to it; a single one that looks like no model is read as one all the same.
  const only = items.length === 1 ? items[0] : null;
  if (only && !/\.bin$/i.test(only.path)) {
    const { parts, ...sorted } = await sortItems(items);
    if (!sorted.model) {
      await put('model', items);
      return;
    }
  }
  await take(items);
});
for (const slot of ['key', 'reference']) {
  $(`${slot}-input`).addEventListener('change', ({ target }) => {
    const items = itemsOfInput(target);
    target.value = '';
    put(slot, items);
  });
}
for (const button of document.querySelectorAll('[data-clear]')) {
  button.addEventListener('click', () => {
    const slot = button.dataset.clear;
    given[slot] = null;
    if (slot === 'model') given.parts = [];
    showNotices([]);
    showSlots();
    $(`${slot}-input`).focus();
    check();
  });
}
for (const button of document.querySelectorAll('[data-sample]')) {
  button.addEventListener('click', () => takeSample(button.dataset.sample));
}
$('check').addEventListener('click', () => check());
$('cancel').addEventListener('click', () => {
  detector.cancel();
  showIdle('Cancelled. Nothing was decided about this model.', { spoken: true });
  $('check').focus();
});
showSlots();
