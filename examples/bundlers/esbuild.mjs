// SPDX-License-Identifier: MIT
// node esbuild.mjs
import { build } from 'esbuild';

await build({
  entryPoints: { main: 'src/main_esbuild.js', worker: 'src/worker_esbuild.js' },
  bundle: true, format: 'esm', splitting: true, minify: true, outdir: 'dist', publicPath: '/',
  loader: { '.wasm': 'file' },
});
