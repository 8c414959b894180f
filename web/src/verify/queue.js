// SPDX-License-Identifier: MIT
// The list of models when there are several: a row for each, which opens its result.
import { $, element } from '../dom.js';
import { t } from '../words/language.js';
import { verdictWords } from '../words/odds.js';
import { oddsElements } from './outcome.js';

/** @typedef {{ model: Item, state: 'queued' | 'working' | 'skipped' | 'done', answer?: object }} Entry */

function verdictOf({ state, answer }) {
  if (state !== 'done') return t(state);
  return answer.type === 'result' ? verdictWords(answer).label : t('failed');
}

const kindOf = ({ state, answer }) => (state !== 'done' ? state : answer.type === 'result' ? answer.verdict : 'problem');

/** @param onPick  (index) => void, for entries that are done */
export function showQueue(entries, picked, onPick) {
  $('queue').hidden = entries.length < 2;
  if (entries.length < 2) return;
  $('queue-count').textContent = t('queueCount', { done: entries.filter(({ state }) => state === 'done').length, all: entries.length });
  $('queue-rows').replaceChildren(...entries.map((entry, index) => {
    const button = element('button', { type: 'button', class: 'link', 'aria-current': index === picked && 'true', disabled: entry.state !== 'done' }, entry.model.path);
    button.addEventListener('click', () => onPick(index));
    const odds = entry.answer?.type === 'result' ? oddsElements(entry.answer.falsePositive) : ['–'];
    return element('tr', { 'data-kind': kindOf(entry) }, element('td', {}, button), element('td', {}, verdictOf(entry)), element('td', {}, ...odds));
  }));
}
