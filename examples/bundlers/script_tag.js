// SPDX-License-Identifier: MIT
import { createKey, embed, extract } from '/node_modules/quadmark/src/index.js';

const key = await createKey();
const { bytes } = await embed(await (await fetch('/model.glb')).arrayBuffer(), { key, id: 'C0FFEE' });
const { verdict, id } = await extract(bytes, { key });
document.getElementById('page').textContent = `${verdict} ${id}`;
