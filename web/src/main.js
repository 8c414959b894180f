// SPDX-License-Identifier: MIT
// Starts the page: language, tabs, drops, and keeping it for use offline.
import { $, fillTexts } from './dom.js';
import { itemsOfDrop } from './files/items.js';
import * as mark from './mark/tab.js';
import { keepForOffline } from './platform/served.js';
import * as verify from './verify/tab.js';
import { currentLanguage, setLanguage, t } from './words/language.js';

const TABS = { verify, mark };
const LANGUAGE_KEY = 'quadmark-language';
let open = 'verify';

function speak(language) {
  setLanguage(language);
  document.documentElement.lang = currentLanguage();
  fillTexts();
  $('announcer').textContent = '';  // said in the other language
  $('language').lang = currentLanguage() === 'de' ? 'en' : 'de';
  document.title = t('pageTitle');
  for (const tab of Object.values(TABS)) tab.refresh();
}

function remembered() {
  try {
    return localStorage.getItem(LANGUAGE_KEY);
  } catch {
    return null;  // storage may be switched off
  }
}

$('language').addEventListener('click', () => {
  const language = currentLanguage() === 'de' ? 'en' : 'de';
  try {
    localStorage.setItem(LANGUAGE_KEY, language);
  } catch {
    // It will be asked for again.
  }
  speak(language);
});

function openTab(name) {
  open = name;
  for (const tab of Object.keys(TABS)) {
    $(tab).hidden = tab !== name;
    $(`tab-${tab}`).setAttribute('aria-selected', String(tab === name));
    $(`tab-${tab}`).tabIndex = tab === name ? 0 : -1;
  }
}

for (const name of Object.keys(TABS)) {
  const button = $(`tab-${name}`);
  button.addEventListener('click', () => openTab(name));
  button.addEventListener('keydown', ({ key }) => {
    if (key !== 'ArrowLeft' && key !== 'ArrowRight') return;
    const other = Object.keys(TABS).find((tab) => tab !== name);
    openTab(other);
    $(`tab-${other}`).focus();
  });
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
addEventListener('drop', async (event) => {
  event.preventDefault();
  lower();
  const tab = TABS[open];
  if (!carriesFiles(event)) {
    tab.complain(t('notAFile'));
    return;
  }
  let items;
  try {
    items = await itemsOfDrop(event.dataTransfer);
  } catch (error) {
    tab.complain(t('folderFailed', error.message));
    return;
  }
  if (items.length === 0) tab.complain(t('noFiles'));
  await tab.take(items);
});

if (location.hash === '#mark') openTab('mark');
speak(remembered() ?? navigator.language.slice(0, 2));
keepForOffline(() => { $('offline').textContent = t('offlineReady'); });
