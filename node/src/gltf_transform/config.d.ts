// SPDX-License-Identifier: MIT
/**
 * What `gltf-transform --config` wants, to get the command `mark`. Re-export it as the default of your own configuration, or
 * call its onProgramReady from yours.
 *
 * @module quadmark/gltf-transform/config
 */

/** The configuration. */
declare const config: {
  /** Adds the command; glTF-Transform's command line calls it with its program, its io and the class of a session. */
  onProgramReady(parameters: { program: unknown; io: unknown; Session: unknown }): Promise<void>;
};
export default config;
