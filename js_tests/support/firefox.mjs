// SPDX-License-Identifier: MIT
// Firefox for tests: the ESR that scripts/setup.sh found, driven over WebDriver BiDi, under Xvfb so that WebGL draws by
// software, with a profile of its own.
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import puppeteer from 'puppeteer-core';

const executablePath = process.env.QUADMARK_FIREFOX || '/usr/bin/firefox-esr';
const xvfb = '/usr/bin/Xvfb';

/** Reason to skip, or false. */
export const noFirefox = [executablePath, xvfb].every((path) => existsSync(path))
  ? false
  : `${executablePath} or ${xvfb} does not exist: run scripts/setup.sh or set QUADMARK_FIREFOX`;

/** A screen nobody sees: { display, end }. Xvfb picks a free number and writes it to descriptor 3. */
function startScreen() {
  const server = spawn(xvfb, ['-displayfd', '3', '-screen', '0', '1280x1024x24', '-nolisten', 'tcp'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe'] });
  return new Promise((resolve, reject) => {
    server.once('error', reject);
    server.once('exit', (status) => reject(new Error(`Xvfb ended with status ${status}`)));
    server.stdio[3].once('data', (text) => resolve({ display: `:${String(text).trim()}`, end: () => server.kill() }));
  });
}

/**
 * A browser that ends with the tests of a file; `after` is node:test's.
 * @param serviceWorkers  'allow', or 'block': as Playwright has it
 * @return {{ browser, display: string, downloads: string }}  puppeteer's browser, its X display, where its downloads go
 */
export async function startFirefox(after, { serviceWorkers = 'block' } = {}) {
  const screen = await startScreen();
  const folder = mkdtempSync(join(tmpdir(), 'quadmark-firefox-'));
  const profile = join(folder, 'profile'), downloads = join(folder, 'downloads');
  for (const part of [profile, downloads]) mkdirSync(part);
  let browser;
  after(async () => {
    await browser?.close();
    screen.end();
    rmSync(folder, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
  });
  browser = await puppeteer.launch({
    browser: 'firefox', executablePath, headless: false, userDataDir: profile,
    timeout: 120_000,  // a loaded machine takes its time
    env: { ...process.env, DISPLAY: screen.display, LIBGL_ALWAYS_SOFTWARE: '1', MOZ_DISABLE_CONTENT_SANDBOX: '1' },
    extraPrefsFirefox: {
      'webgl.force-enabled': true, 'webgl.disabled': false, 'dom.webnotifications.enabled': false,
      'datareporting.policy.dataSubmissionEnabled': false, 'app.update.enabled': false, 'network.captive-portal-service.enabled': false,
      'network.connectivity-service.enabled': false, 'browser.safebrowsing.downloads.enabled': false,
      'dom.serviceWorkers.enabled': serviceWorkers === 'allow', 'browser.download.folderList': 2, 'browser.download.dir': downloads, 'browser.download.useDownloadDir': true, 'browser.download.alwaysOpenPanel': false,
    },
  });
  return { browser, display: screen.display, downloads };
}
