// SPDX-License-Identifier: MIT
// Small helpers for the document.
import { t } from './words/language.js';

export const $ = (id) => document.getElementById(id);

/** An element with attributes and children; a text child is text, never markup. */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [attribute, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(attribute, '');
    else if (value !== false && value != null) made.setAttribute(attribute, value);
  }
  made.append(...children);
  return made;
}

/** Writes the texts of the current language into every element that names one. */
export function fillTexts(root = document) {
  for (const place of root.querySelectorAll('[data-t]')) place.textContent = t(place.dataset.t);
  for (const place of root.querySelectorAll('[data-t-label]')) place.setAttribute('aria-label', t(place.dataset.tLabel));
}

/** Says it to screen readers, the same words again included. */
export function announce(text) {
  $('announcer').textContent = '';
  requestAnimationFrame(() => { $('announcer').textContent = text; });
}

/** Fills a list with sentences. */
export function showSentences(list, sentences) {
  list.replaceChildren(...sentences.map((text) => element('li', {}, text)));
}

/** Fills a <dl> with [name, value] pairs. */
export function showFacts(list, facts) {
  list.replaceChildren(...facts.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]));
}

/** Object URLs that belong together: all are given back at once. */
export class Urls {
  #urls = [];

  of(content, type) {
    const url = URL.createObjectURL(new Blob([content], { type }));
    this.#urls.push(url);
    return url;
  }

  revoke() {
    for (const url of this.#urls) URL.revokeObjectURL(url);
    this.#urls = [];
  }
}

/** A group of radio buttons drawn as one row of segments; `onChange(value)`. */
export function segments(name, labelText, choices, value, onChange) {
  const inputs = choices.map(([choice, text]) => {
    const input = element('input', { type: 'radio', name, value: choice, checked: choice === value });
    input.addEventListener('change', () => onChange(choice));
    return element('label', {}, input, element('span', { 'data-t': text }, t(text)));
  });
  return element('div', { class: 'segments', role: 'radiogroup', 'data-t-label': labelText, 'aria-label': t(labelText) }, ...inputs);
}
