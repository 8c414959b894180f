// SPDX-License-Identifier: MIT
// What to hide: a picture with its size and threshold, an ID or a text.
import { $, segments } from '../dom.js';
import { itemsOfInput } from '../files/items.js';
import { sizeWords, t, wholeWords } from '../words/language.js';
import { bestThreshold, drawBits, lightOf, openPicture, thresholded } from './logo.js';

const KINDS = [['image', 'payloadImage'], ['id', 'payloadId'], ['text', 'payloadText']];

/** Edits the payload in the document and tells `onChange` of every change. */
export class PayloadForm {
  #kind = 'image';
  #file = null;
  #picture = null;
  #image = null;
  #onChange;
  #onProblem;

  constructor(onChange, onProblem) {
    this.#onChange = onChange;
    this.#onProblem = onProblem;
    $('payload-kinds').append(segments('payload', 'payload', KINDS, 'image', (kind) => {
      this.#kind = kind;
      for (const [name] of KINDS) $(`payload-${name}`).hidden = name !== kind;
      onChange();
    }));
    $('logo-input').addEventListener('change', ({ target }) => {
      const [item] = itemsOfInput(target);
      target.value = '';
      if (item) this.take(item.file);
    });
    for (const id of ['logo-threshold', 'logo-invert']) $(id).addEventListener('input', () => this.#render());
    $('logo-size').addEventListener('input', () => this.#render());
    for (const id of ['id-input', 'text-input']) $(id).addEventListener('input', onChange);
  }

  /** Takes a picture file. @param side  pixels it should have, or undefined */
  async take(file, side) {
    try {
      this.#picture = await openPicture(file);
    } catch {
      this.#onProblem(t('logoFailed', file.name));
      return;
    }
    this.#file = file;
    if (side) $('logo-size').value = side;
    $('logo-threshold').value = bestThreshold(lightOf(this.#picture, Number($('logo-size').value)));
    this.#render();
  }

  /** The largest side that fits the model well, as a proposal while no picture is there. */
  propose(side) {
    if (!this.#picture) $('logo-size').value = Math.max(8, Math.min(64, side));
  }

  #render() {
    if (!this.#picture) return;
    const threshold = Number($('logo-threshold').value);
    this.#image = thresholded(lightOf(this.#picture, Number($('logo-size').value)), threshold / 100, $('logo-invert').checked);
    drawBits($('logo-preview'), this.#image);
    $('logo-adjust').hidden = false;
    this.refresh();
    this.#onChange();
  }

  /** Writes the texts again. */
  refresh() {
    $('logo-file').textContent = this.#file ? `${this.#file.name} (${sizeWords(this.#file.size)})` : t('logoHint');
    $('logo-file').closest('.slot').classList.toggle('filled', this.#file !== null);
    $('logo-preview').setAttribute('aria-label', t('logoAlt'));
    if (!this.#image) return;
    const { width, height, bits } = this.#image;
    $('logo-size-out').textContent = `${width} × ${height}`;
    $('logo-threshold-out').textContent = `${$('logo-threshold').value} %`;
    $('logo-told').textContent = t('logoPreview', { width, height, ink: wholeWords(bits.reduce((sum, bit) => sum + bit, 0)) });
  }

  /** Pixels of the longer side of the picture that would be hidden; 0 when it is no picture. */
  get side() {
    return this.#kind === 'image' && this.#image ? Math.max(this.#image.width, this.#image.height) : 0;
  }

  /** { image } | { id } | { text }, or the name of the text that says what is missing. */
  get value() {
    if (this.#kind === 'image') return this.#image ? { image: this.#image } : 'needLogo';
    if (this.#kind === 'id') return /^[0-9a-f]{1,16}$/i.test($('id-input').value.trim()) ? { id: $('id-input').value.trim() } : 'needId';
    return $('text-input').value.trim() ? { text: $('text-input').value.trim() } : 'needText';
  }

  /** What a failure about the payload is about. */
  get name() {
    return this.#kind === 'image' ? this.#file?.name ?? '' : t(this.#kind === 'id' ? 'payloadId' : 'payloadText');
  }
}
