// SPDX-License-Identifier: MIT
// What axe-core says of a page.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** Fails unless axe-core finds nothing. Its script is put in past the page's policy, by the debugger. */
export async function assertAccessible(page, state) {
  const session = await page.context().newCDPSession(page);
  await session.send('Runtime.evaluate', { expression: axe });
  await session.detach();
  const found = await page.evaluate(async () => (await globalThis.axe.run(document)).violations
    .map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.map(({ html }) => html.slice(0, 120)).join(' | ')}`));
  assert.deepEqual(found, [], state);
}
