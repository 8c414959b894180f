// SPDX-License-Identifier: MIT
// vite build: every model that is imported or lies in public/ comes out marked. The key is in a file outside the repository;
// its name is in QUADMARK_KEY_FILE.
import { defineConfig } from 'vite';
import { quadmark } from 'quadmark/vite';

export default defineConfig({
  plugins: [quadmark({ id: 'C0FFEE', salt: (file) => file.split('/').at(-1) })],
});
