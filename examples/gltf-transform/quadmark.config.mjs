// SPDX-License-Identifier: MIT
// gltf-transform --config quadmark.config.mjs mark IN.glb OUT.glb --key KEY.json --id ID
export { default } from 'quadmark/gltf-transform/config';
