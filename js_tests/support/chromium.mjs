// SPDX-License-Identifier: MIT
// Chromium for tests: the one scripts/setup.sh found, headless, with a profile of its own.
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium } from 'playwright-core';

const executablePath = process.env.QUADMARK_CHROMIUM || '/usr/bin/chromium';

/** Reason to skip, or false. */
export const noChromium = existsSync(executablePath)
  ? false
  : `${executablePath} does not exist: run scripts/setup.sh or set QUADMARK_CHROMIUM`;

/**
 * A browser context that closes when the test `t` ends.
 * @param webgl    whether pages may draw with WebGL, by software
 * @param options  further ones of Playwright's launchPersistentContext()
 */
export async function openChromium(t, { webgl = false, ...options } = {}) {
  const profile = mkdtempSync(join(tmpdir(), 'quadmark-chromium-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath,
    headless: true,
    timeout: 120_000,  // a loaded machine takes its time
    ...options,
    args: ['--headless', '--no-sandbox', '--disable-quic', '--disable-dev-shm-usage', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync',
      ...(webgl ? ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] : ['--disable-gpu'])],
  });
  // In this order: a hook that fails on a profile still being written would keep the browser, and the test, from ending.
  t.after(async () => {
    await context.close();
    rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
  });
  return context;
}
