// SPDX-License-Identifier: MIT
// The page's side of the 3D view: a canvas that is handed to the drawing thread, and what turns it. The thread, and
// three.js with it, is fetched when the view first scrolls into sight.
import { element, fillTexts, segments, Urls } from '../dom.js';
import { startViewWorker } from '../platform/served.js';
import { percent, t } from '../words/language.js';
import { followKeys, followPointers } from './input.js';

const MOST_PIXELS = 2;           // device pixels per CSS pixel
const ASK_BYTES = 96 * 2 ** 20;  // larger models are drawn when asked for

export class ViewPanel {
  #root;
  #worker = null;
  #sight = null;
  #resizing = null;
  #urls = new Urls();

  constructor(root) {
    this.#root = root;
    root.classList.add('view');
  }

  /**
   * Shows a model as soon as it is looked at.
   * @param request  { kind: 'evidence', model: Item, parts: Item[], evidence } or { kind: 'compare', model, parts, after: { model, parts } }
   */
  offer(request) {
    this.close();
    const button = element('button', { type: 'button', class: 'view-start', 'data-t': request.kind === 'compare' ? 'compareLoad' : 'viewLoad' });
    button.addEventListener('click', () => this.#open(request));
    const waits = request.model.file.size > ASK_BYTES;
    this.#root.replaceChildren(element('div', { class: 'view-stage' }, button), ...(waits ? [] : this.#unusable(request)));
    fillTexts(this.#root);
    if (waits) return;
    this.#sight = new IntersectionObserver((seen) => {
      if (!seen.some(({ isIntersecting }) => isIntersecting)) return;
      this.#sight?.disconnect();
      this.#open(request);
    });
    this.#sight.observe(this.#root);
  }

  /** Ends the thread and empties the place. */
  close() {
    this.#sight?.disconnect();
    this.#resizing?.disconnect();
    this.#worker?.terminate();
    this.#worker = this.#sight = this.#resizing = null;
    this.#urls.revoke();
    this.#root.replaceChildren();
    delete this.#root.dataset.state;
  }

  #send(message) {
    this.#worker?.postMessage(message);
  }

  #open(request) {
    this.#sight?.disconnect();
    const canvas = element('canvas', { tabindex: '0', role: 'img', 'data-t-label': 'viewLabel' });
    const status = element('p', { class: 'view-status', role: 'status' }, t('viewLoading'));
    const stage = element('div', { class: 'view-stage' }, canvas, status);
    this.#root.replaceChildren(stage, ...this.#unusable(request));
    this.#root.dataset.state = 'loading';
    fillTexts(this.#root);
    const size = () => ({ width: Math.max(1, stage.clientWidth), height: Math.max(1, stage.clientHeight), pixelRatio: Math.min(MOST_PIXELS, devicePixelRatio) });
    const fail = (reason) => {
      this.close();
      this.#root.dataset.state = 'failed';
      this.#root.replaceChildren(element('p', { class: 'faint' }, t('viewFailed', t(reason))));
    };
    let worker, surface;
    try {
      surface = canvas.transferControlToOffscreen();
      worker = this.#worker = startViewWorker();
    } catch {
      fail('noWebgl');
      return;
    }
    worker.onerror = () => fail('noShape');
    worker.onmessage = ({ data }) => {
      if (data.type === 'failed') fail(data.reason);
      if (data.type === 'picture') this.#showPrint(data.blob);
      if (data.type !== 'ready') return;
      status.remove();
      this.#root.querySelector('.view-waiting').replaceWith(...this.#controls(request, data, stage));
      fillTexts(this.#root);
      this.#root.dataset.state = 'ready';
    };
    const { kind, ...models } = request;
    worker.postMessage({ type: 'open', canvas: surface, ...size(), ...models }, [surface]);
    // Hidden, on paper or behind the other tab, it keeps its size and its picture.
    this.#resizing = new ResizeObserver(() => { if (stage.clientWidth > 0) this.#send({ type: 'size', ...size() }); });
    this.#resizing.observe(stage);
    const move = {
      turn: (azimuth, height) => this.#send({ type: 'turn', azimuth, height }),
      zoom: (factor) => this.#send({ type: 'zoom', factor }),
      reset: () => this.#send({ type: 'reset' }),
    };
    followPointers(canvas, move);
    followKeys(canvas, move);
  }

  /** The controls' place while there is nothing to control: what stands below must not move when they come. */
  #unusable(request) {
    return [element('div', { class: 'view-waiting' }, ...this.#controls(request, { coloured: request.evidence?.length > 0, most: 0 }))];
  }

  /** Elements below the stage; without `stage` they only take their room. */
  #controls({ kind }, { coloured, most }, stage = null) {
    const help = element('p', { class: 'faint view-help', 'data-t': 'viewHelp' });
    if (kind === 'compare') return [...this.#comparing(most, stage), help];
    return [...(coloured ? this.#shading() : [element('p', { class: 'faint', 'data-t': 'noEvidence' })]), help];
  }

  #comparing(most, stage) {
    const legend = element('div', { class: 'legend' }, element('span', { 'data-t': 'legendStill' }), element('span', { class: 'ramp moved', 'aria-hidden': 'true' }), element('span', {}, t('legendMoved', percent(most))));
    const slider = element('input', { type: 'range', min: 0, max: 100, value: 50, class: 'split', 'data-t-label': 'compareSlider' });
    const line = element('span', { class: 'split-line', 'aria-hidden': 'true' });
    const follow = () => {
      line.dataset.at = slider.value;
      this.#send({ type: 'split', share: slider.value / 100 });
      line.style.setProperty('inset-inline-start', `${slider.value}%`);
    };
    slider.addEventListener('input', follow);
    const note = element('p', { class: 'faint', 'data-t': 'compareSlider' });
    const choose = (mode) => {
      const wipe = mode === 'wipe';
      slider.hidden = line.hidden = note.hidden = !wipe;
      legend.hidden = wipe;
      this.#send({ type: 'colour', coloured: !wipe });
      if (wipe) follow();
      else this.#send({ type: 'split', share: null });
    };
    stage?.append(line);
    const modes = segments('compare-mode', 'compare', [['wipe', 'compareWipe'], ['heat', 'compareHeat']], 'wipe', choose);
    if (stage) choose('wipe');
    else legend.hidden = true;
    return [slider, note, element('div', { class: 'view-controls' }, modes, legend)];
  }

  #shading() {
    const legend = element('div', { class: 'legend' }, element('span', { 'data-t': 'legendAgainst' }), element('span', { class: 'ramp evidence', 'aria-hidden': 'true' }), element('span', { 'data-t': 'legendFor' }));
    const note = element('p', { class: 'faint', 'data-t': 'legendNote' });
    const choose = (mode) => {
      legend.hidden = note.hidden = mode === 'plain';
      this.#send({ type: 'colour', coloured: mode === 'evidence' });
    };
    return [element('div', { class: 'view-controls' }, segments('shade', 'shading', [['evidence', 'shadeEvidence'], ['plain', 'shadePlain']], 'evidence', choose), legend), note];
  }

  /** A picture of the view stands in for the canvas on paper. */
  #showPrint(blob) {
    this.#urls.revoke();
    let picture = this.#root.querySelector('.view-print');
    if (!picture) this.#root.append(picture = element('img', { class: 'view-print', alt: '' }));
    picture.src = this.#urls.of(blob, 'image/png');
  }
}
