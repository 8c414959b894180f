// SPDX-License-Identifier: MIT
// Three ways to a model; a viewer would load them. This page says how large they are.
import imported from './model.glb?url';

const urls = [imported, new URL('./other.glb', import.meta.url).href, `${import.meta.env.BASE_URL}public.glb`];
Promise.all(urls.map(async (url) => (await (await fetch(url)).arrayBuffer()).byteLength)).then((sizes) => {
  document.getElementById('models').textContent = sizes.join(' ');
});
