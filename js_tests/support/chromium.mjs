// SPDX-License-Identifier: MIT
// Chromium for tests: the one scripts/setup.sh found, headless, with a profile of its own.
import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';
import { temporaryFolder } from './files.mjs';

const executablePath = process.env.QUADMARK_CHROMIUM || '/usr/bin/chromium';

/** Reason to skip, or false. */
export const noChromium = existsSync(executablePath)
  ? false
  : `${executablePath} does not exist: run scripts/setup.sh or set QUADMARK_CHROMIUM`;

/**
 * A browser context that closes when the test `t` ends.
 * @param webgl  whether pages may draw with WebGL, by software
 */
export async function openChromium(t, { webgl = false } = {}) {
  const context = await chromium.launchPersistentContext(temporaryFolder(t), {
    executablePath,
    headless: true,
    args: ['--headless', '--no-sandbox', '--disable-quic', '--disable-dev-shm-usage', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync',
      ...(webgl ? ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] : ['--disable-gpu'])],
  });
  t.after(() => context.close());
  return context;
}
