// SPDX-License-Identifier: MIT
// Entry `quadmark/recipients`: the files around marks for many recipients.
export { parseRecipients } from './recipient_list.js';
export { parseRegistry, registryLine } from './registry.js';
