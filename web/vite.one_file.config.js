// SPDX-License-Identifier: MIT
import { defineConfig } from 'vite';
import { oneFile } from './build/one_file.mjs';
import { fillTexts } from './build/texts.mjs';

export default defineConfig({
  base: './',
  publicDir: false,
  plugins: [fillTexts(), oneFile('quadmark.html')],
  worker: { format: 'iife', rolldownOptions: { output: { codeSplitting: false } } },
  build: {
    target: 'es2023',
    emptyOutDir: false,  // beside the page that is served
    assetsInlineLimit: () => true,
    cssCodeSplit: false,
    modulePreload: { polyfill: false },
    rolldownOptions: { output: { codeSplitting: false } },
    reportCompressedSize: false,
    chunkSizeWarningLimit: 1e5,
  },
});
