// SPDX-License-Identifier: MIT
// Draco's decoder as three.js ships it, fetched for the first model that needs it. (The product's own wasm decodes as
// well, but keeps what it decoded to itself.)
import createDecoder from 'three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js';
import decoderUrl from 'three/examples/jsm/libs/draco/gltf/draco_decoder.wasm?url';

/** Draco's decoder module; rejects when it cannot be fetched. */
export async function openDracoDecoder() {
  const response = await fetch(decoderUrl);
  if (!response.ok) throw new Error(`Draco's decoder: HTTP status ${response.status}`);
  return createDecoder({ wasmBinary: await response.arrayBuffer() });
}
