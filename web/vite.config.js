// SPDX-License-Identifier: MIT
import { defineConfig } from 'vite';
import { keepOffline } from './build/service_worker.mjs';
import { fillTexts } from './build/texts.mjs';

export default defineConfig({
  base: './',  // the page works from any folder of any server
  plugins: [fillTexts(), keepOffline()],
  worker: { format: 'es' },
  build: {
    target: 'es2023',
    assetsInlineLimit: 0,                // data: URLs of wasm or scripts are refused by the page's policy
    modulePreload: { polyfill: false },  // it would be an inline script
  },
});
