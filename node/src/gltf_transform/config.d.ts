// SPDX-License-Identifier: MIT
// Types of `quadmark/gltf-transform/config`: what `gltf-transform --config` wants. Re-export it as the default of your own
// configuration, or call its onProgramReady from yours.
declare const config: {
  onProgramReady(parameters: { program: unknown; io: unknown; Session: unknown }): Promise<void>;
};
export default config;
