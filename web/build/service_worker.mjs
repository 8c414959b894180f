// SPDX-License-Identifier: MIT
// Vite plugin: adds sw.js, which keeps every file of this build for use without a network.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

const publicFiles = (folder) => readdirSync(folder).filter((name) => !name.startsWith('.'));

export function keepOffline() {
  let folder;
  return {
    name: 'quadmark-service-worker',
    apply: 'build',
    configResolved({ publicDir }) { folder = publicDir; },
    generateBundle: {
      order: 'post',
      handler(_, bundle) {
        const hash = createHash('sha256');
        const files = Object.values(bundle).sort((a, b) => (a.fileName < b.fileName ? -1 : 1));
        for (const file of files) hash.update(file.fileName).update(file.code ?? file.source);
        for (const name of publicFiles(folder)) hash.update(name).update(readFileSync(join(folder, name)));
        const names = [...files.map(({ fileName }) => fileName), ...publicFiles(folder)].map((name) => `./${name}`);
        const source = readFileSync(new URL('./service_worker_template.js', import.meta.url), 'utf8')
          .replace('__VERSION__', () => hash.digest('hex').slice(0, 16))
          .replace("'__FILES__'", () => JSON.stringify(names));
        this.emitFile({ type: 'asset', fileName: 'sw.js', source });
      },
    },
  };
}
