// SPDX-License-Identifier: MIT
// A build step with glTF-Transform: tidy up, mark last.
//
//   node mark.mjs KEY.json IN.glb OUT.glb ID
import { readFile } from 'node:fs/promises';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { dedup, prune } from '@gltf-transform/functions';
import { quadmark } from 'quadmark/gltf-transform';

const [keyFile, input, output, id] = process.argv.slice(2);
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
const document = await io.read(input);
await document.transform(
  dedup(),
  prune(),
  quadmark({
    key: await readFile(keyFile),
    id,
    onReport: ({ strength, capacityClass, distortion }) =>
      console.log(`${input}: ${strength}, capacity ${capacityClass}, SNR ${distortion.snrDb.toFixed(1)} dB`),
  }),
);
await io.write(output, document);
