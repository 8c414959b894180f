// SPDX-License-Identifier: MIT
// What differs between the page on a server and the page as one file: here, workers and samples are files beside it.

export const startWorker = () => new Worker(new URL('../worker/index.js', import.meta.url), { type: 'module' });
export const startViewWorker = () => new Worker(new URL('../view3d/worker.js', import.meta.url), { type: 'module' });

const SAMPLES = {
  'marked.glb': new URL('../../samples/marked.glb', import.meta.url),
  'damaged.glb': new URL('../../samples/damaged.glb', import.meta.url),
  'unmarked.glb': new URL('../../samples/unmarked.glb', import.meta.url),
  'key.json': new URL('../../samples/key.json', import.meta.url),
  'wrong-key.json': new URL('../../samples/wrong-key.json', import.meta.url),
  'logo.png': new URL('../../samples/logo.png', import.meta.url),
};

/** A sample as a File; rejects with the reason. */
export async function openSample(name) {
  const response = await fetch(SAMPLES[name]);
  if (!response.ok) throw new Error(`${name}: HTTP status ${response.status}`);
  return new File([await response.arrayBuffer()], name);
}

/** Keeps the page for use without a network; `onReady` once everything is kept. */
export function keepForOffline(onReady) {
  if (!import.meta.env.PROD || !navigator.serviceWorker) return;
  addEventListener('load', async () => {
    try {
      await navigator.serviceWorker.register('./sw.js');
      await navigator.serviceWorker.ready;
      onReady();
    } catch {
      // The page works as well without.
    }
  });
}
