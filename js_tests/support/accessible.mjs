// SPDX-License-Identifier: MIT
// What axe-core says of a page.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { FirefoxPage } from './firefox_page.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** Runs a script past the page's policy, as a debugger does. */
async function inject(page, script) {
  if (page instanceof FirefoxPage) {
    await page.inject(script);
    return;
  }
  const session = await page.context().newCDPSession(page);
  await session.send('Runtime.evaluate', { expression: script });
  await session.detach();
}

/** Fails unless axe-core finds nothing. */
export async function assertAccessible(page, state) {
  await inject(page, axe);
  const found = await page.evaluate(async () => (await globalThis.axe.run(document)).violations
    .map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.map(({ html }) => html.slice(0, 120)).join(' | ')}`));
  assert.deepEqual(found, [], state);
}
