// SPDX-License-Identifier: MIT
// What differs between the page on a server and the page as one file: here, workers and samples are inside it.
import damaged from '../../samples/damaged.glb?url&inline';
import key from '../../samples/key.json?url&inline';
import logo from '../../samples/logo.png?url&inline';
import marked from '../../samples/marked.glb?url&inline';
import unmarked from '../../samples/unmarked.glb?url&inline';
import wrongKey from '../../samples/wrong-key.json?url&inline';
import ViewWorker from '../view3d/worker.js?worker&inline';
import JobWorker from '../worker/index.js?worker&inline';

export const startWorker = () => new JobWorker();
export const startViewWorker = () => new ViewWorker();

const SAMPLES = {
  'marked.glb': marked, 'damaged.glb': damaged, 'unmarked.glb': unmarked, 'key.json': key, 'wrong-key.json': wrongKey, 'logo.png': logo,
};

/** A sample as a File. */
export async function openSample(name) {
  return new File([await (await fetch(SAMPLES[name])).arrayBuffer()], name);
}

/** It is on disk already. */
export function keepForOffline() {
  document.getElementById('one-file').hidden = true;
}
