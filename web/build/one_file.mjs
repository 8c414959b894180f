// SPDX-License-Identifier: MIT
// Vite plugin: the whole page as one HTML file that works from a disk, without a server and without a network. Its policy
// allows exactly the script and the style inside it, workers from them, and no connection but to data inside it.
import { createHash } from 'node:crypto';
import { fileURLToPath } from 'node:url';

const hashOf = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

/** Of the page as one file; scripts and styles are named by their hashes. */
export const oneFilePolicy = (script, style) => [
  "default-src 'none'", `script-src ${hashOf(script)} 'wasm-unsafe-eval'`, 'worker-src blob:', 'connect-src data:',
  `style-src ${hashOf(style)}`, 'img-src blob: data:', "base-uri 'none'", "form-action 'none'",
].join('; ');

export function oneFile(fileName) {
  const served = fileURLToPath(new URL('../src/platform/served.js', import.meta.url));
  const inside = fileURLToPath(new URL('../src/platform/one_file.js', import.meta.url));
  return {
    name: 'quadmark-one-file',
    enforce: 'pre',
    async resolveId(source, importer, options) {
      if (!source.endsWith('/served.js')) return null;
      const found = await this.resolve(source, importer, { ...options, skipSelf: true });
      return found?.id === served ? inside : found;
    },
    generateBundle: {
      order: 'post',
      handler(_, bundle) {
        const files = Object.values(bundle);
        const one = (test, what) => {
          const found = files.filter(test);
          if (found.length !== 1) this.error(`one file: expected one ${what}, found ${found.map((file) => file.fileName).join(', ') || 'none'}`);
          return found[0];
        };
        const script = one((file) => file.type === 'chunk', 'script').code.replaceAll('</script', '<\\/script');
        const style = String(one((file) => file.fileName.endsWith('.css'), 'style sheet').source);
        const html = String(one((file) => file.fileName.endsWith('.html'), 'page').source)
          .replace(/<script type="module"[^>]*><\/script>/, '')
          .replace(/<link rel="(stylesheet|icon)"[^>]*>/g, '')
          .replace(/(http-equiv="Content-Security-Policy" content=)"[^"]*"/, (_all, start) => `${start}"${oneFilePolicy(script, style)}"`)
          .replace('</head>', () => `<style>${style}</style>\n</head>`)
          .replace('</body>', () => `<script type="module">${script}</script>\n</body>`);
        for (const name of Object.keys(bundle)) delete bundle[name];
        this.emitFile({ type: 'asset', fileName, source: html });
      },
    },
  };
}
