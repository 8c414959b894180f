// SPDX-License-Identifier: MIT
// QuadmarkError and the table of error codes: the same list as ErrorCode in core/include/quadmark/result.h, in the same
// order (a test compares them), with the exit status the command line gives each.

/** Exit status by error code. 0 = done or match, 3 = no mark and 4 = inconclusive are results, not errors. */
export const ERROR_EXIT_STATUS = Object.freeze({
  bad_file: 1,
  unsupported_file: 1,
  bad_mesh: 1,
  bad_option: 2,
  bad_key: 1,
  bad_image: 1,
  capacity: 1,
  unsupported_version: 1,
  too_large: 1,
  io: 1,
  aborted: 1,
  internal: 1,
});

/** Every failure of the package: `code` is one of the table above, `message` names the place. */
export class QuadmarkError extends Error {
  constructor(code, message, options) {
    super(message, options);
    this.name = 'QuadmarkError';
    this.code = code;
  }
}
