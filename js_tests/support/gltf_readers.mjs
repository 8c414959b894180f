// SPDX-License-Identifier: MIT
// What others say of a glTF: the Khronos validator and glTF-Transform with every extension and decoder it has.
import { Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import draco3d from 'draco3dgltf';
import validator from 'gltf-validator';
import { MeshoptDecoder } from 'meshoptimizer';
import { isGlb } from './gltf.mjs';

/** How many errors the Khronos validator finds. */
export async function validatorErrors(model, resources = {}) {
  const { issues } = await validator.validateBytes(new Uint8Array(model), {
    maxIssues: 0,
    externalResourceFunction: async (uri) => {
      const found = Object.entries(resources).find(([name]) => decodeURIComponent(name) === decodeURIComponent(uri));
      if (!found) throw new Error(`no ${uri}`);
      return new Uint8Array(found[1]);
    },
  });
  return issues.numErrors;
}

const reader = (async () => {
  await MeshoptDecoder.ready;
  return new NodeIO().setLogger(new Logger(Logger.Verbosity.ERROR)).registerExtensions(ALL_EXTENSIONS).registerDependencies({
    'draco3d.decoder': await draco3d.createDecoderModule(),
    'meshopt.decoder': MeshoptDecoder,
  });
})();

/** The model as a glTF-Transform document; fails where glTF-Transform does. */
export async function readDocument(model, resources = {}) {
  const io = await reader;
  if (isGlb(model)) return io.readBinary(new Uint8Array(model));
  const files = Object.fromEntries(Object.entries(resources).map(([uri, bytes]) => [uri, new Uint8Array(bytes)]));
  return io.readJSON({ json: JSON.parse(Buffer.from(model).toString()), resources: files });
}
