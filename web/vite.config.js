// SPDX-License-Identifier: MIT
import { defineConfig } from 'vite';

export default defineConfig({
  base: './',  // the page works from any folder of any server
  worker: { format: 'es' },
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,                // data: URLs of wasm or scripts are refused by the page's policy
    modulePreload: { polyfill: false },  // it would be an inline script
  },
});
