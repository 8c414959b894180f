// SPDX-License-Identifier: MIT
// The right-hand side of a tab: one of its panels idle, working, problem or result at a time. Only writes to the document.
import { $, announce } from './dom.js';
import { currentLanguage, hasText, t } from './words/language.js';
import { missingWords, problemWords } from './words/problems.js';

const NAMES = ['idle', 'working', 'problem', 'result'];

export class Panels {
  #prefix;
  #label;
  #view;
  #ticking = null;

  /**
   * @param prefix  of the ids
   * @param label   name of the text that says what is done to the model
   * @param view    ViewPanel among the result, closed when another panel comes
   */
  constructor(prefix, label, view) {
    this.#prefix = prefix;
    this.#label = label;
    this.#view = view;
  }

  #part(name) {
    return $(this.#prefix + name);
  }

  show(panel, state = panel) {
    for (const name of NAMES) this.#part(name).hidden = name !== panel;
    this.#part('outcome').dataset.state = state;
    this.#part('outcome').setAttribute('aria-busy', String(panel === 'working'));
    clearInterval(this.#ticking);
    if (panel !== 'result') this.#view.close();
  }

  /** On narrow screens the outcome lies below what was filled in. */
  bringIntoSight() {
    if (matchMedia('(max-width: 56rem)').matches) this.#part('outcome').scrollIntoView({ block: 'start' });
  }

  idle(text, { spoken = false } = {}) {
    this.#part('idle-text').textContent = text;
    if (spoken) announce(text);
    this.show('idle');
  }

  working(modelName) {
    this.#part('working-name').textContent = modelName;
    const started = performance.now();
    const tick = () => {
      const seconds = Math.floor((performance.now() - started) / 1000);
      this.#part('elapsed').textContent = seconds > 0 ? t('seconds', seconds) : '';
    };
    this.show('working');
    tick();
    this.#ticking = setInterval(tick, 250);
    this.progress({ stage: 'load', done: 0 });
    announce(`${t(this.#label)} ${modelName}`);
  }

  progress({ stage, done }) {
    this.#part('progress').value = done;
    this.#part('progress').dataset.stage = stage;
    this.#part('stage').textContent = `${t(hasText(`stage_${stage}`) ? `stage_${stage}` : 'stage_other')} …`;
  }

  /** Shows why there is no result. @param names  file name by "model", "key", "reference" and "logo" */
  problem(answer, names) {
    const missing = answer.type === 'missing';
    const { title, text, hint } = missing ? missingWords(answer.uris, names.model) : problemWords(answer, names);
    this.#part('problem-title').textContent = title;
    this.#part('problem-text').textContent = text;
    this.#part('problem-text').lang = missing ? currentLanguage() : 'en';
    this.#part('problem-hint').textContent = hint;
    announce([title, text, hint].join(' '));
    this.show('problem', missing ? 'missing' : 'problem');
  }
}
