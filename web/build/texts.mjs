// SPDX-License-Identifier: MIT
// Vite plugin: writes the English texts into index.html, so that it reads well before any script runs.
import { TEXTS } from '../src/words/language.js';

const escape = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');

export function fillTexts() {
  return {
    name: 'quadmark-texts',
    transformIndexHtml: {
      order: 'pre',
      handler: (html) => html
        .replace(/ data-t="(\w+)"([^>]*)></g, (_, name, rest) => ` data-t="${name}"${rest}>${escape(TEXTS[name][0])}<`)
        .replace(/ data-t-label="(\w+)"/g, (all, name) => `${all} aria-label="${escape(TEXTS[name][0])}"`),
    },
  };
}
