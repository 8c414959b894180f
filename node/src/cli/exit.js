// SPDX-License-Identifier: MIT
// Exit status of the command line.
import { ERROR_EXIT_STATUS } from '../index_node.js';

export const EXIT = Object.freeze({ done: 0, failure: 1, usage: 2, none: 3, inconclusive: 4 });

export const exitOfError = (error) => ERROR_EXIT_STATUS[error.code] ?? EXIT.failure;

export const exitOfVerdict = (verdict) => ({ match: EXIT.done, none: EXIT.none })[verdict] ?? EXIT.inconclusive;

/** One status for many inputs: the first of usage, failure, none, inconclusive that occurred. */
export function worstExit(statuses) {
  return [EXIT.usage, EXIT.failure, EXIT.none, EXIT.inconclusive].find((status) => statuses.includes(status)) ?? EXIT.done;
}
