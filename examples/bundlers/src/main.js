// SPDX-License-Identifier: MIT
import { verify } from './verify.js';

const show = (id, text) => { document.getElementById(id).textContent = text; };
const model = new URL('/model.glb', location.href).href;

verify(model).then((text) => show('page', text), (error) => show('page', String(error)));

const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
worker.onmessage = ({ data }) => show('worker', data);
worker.onerror = ({ message }) => show('worker', message);
worker.postMessage(model);
