// SPDX-License-Identifier: MIT
// vite build
export default { worker: { format: 'es' }, optimizeDeps: { exclude: ['quadmark'] } };
