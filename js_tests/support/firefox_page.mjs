// SPDX-License-Identifier: MIT
// A page in Firefox under the names that Playwright gives things, so that one test body serves both browsers: puppeteer-core
// drives it over WebDriver BiDi. Only what the tests use is here; like there, acting waits until it is possible.
import { readdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { setTimeout as pause } from 'node:timers/promises';
import { dragFiles } from './x11_drag.mjs';

const PATIENCE = 30000;  // milliseconds

/** In the page: the elements that `steps` lead to, [{ css, hasText, has, nth }]. */
function elementsOf(steps) {
  const holds = (text, part) => text.replace(/\s+/g, ' ').toLowerCase().includes(part.toLowerCase());
  let found = [document];
  for (const { css, hasText, has, nth } of steps) {
    if (css !== undefined) found = found.flatMap((root) => [...root.querySelectorAll(css)]);
    if (hasText !== undefined) found = found.filter((element) => holds(element.textContent, hasText));
    if (has !== undefined) found = found.filter((element) => element.querySelector(has));
    if (nth !== undefined) found = found.slice(nth, nth + 1);
  }
  return found;
}

/** In the page: whether an element can be seen. */
function isShown(element) {
  const { width, height } = element.getBoundingClientRect();
  return width > 0 && height > 0 && getComputedStyle(element).visibility === 'visible';
}

/**
 * In the page: keeps the next click from everything but `element`, until endGuard() says whether that was clicked. Pressed
 * on it and released beside it, because it moved in between, is no click.
 */
function guardClick(element) {
  let pressed = false, clicked;
  const whenClicked = new Promise((resolve) => { clicked = () => resolve(true); });
  const guard = (event) => {
    const hit = element.contains(event.target);
    if (event.type === 'pointerdown') pressed = hit;
    if (event.type === 'click' && hit) clicked();
    if (pressed) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  const types = ['pointerdown', 'mousedown', 'pointerup', 'mouseup', 'click'];
  for (const type of types) addEventListener(type, guard, true);
  globalThis.endGuard = async () => {
    // The click may come a little after the driver believes to have made it.
    const hit = pressed && await Promise.race([whenClicked, new Promise((resolve) => { setTimeout(resolve, 2000, false); })]);
    for (const type of types) removeEventListener(type, guard, true);
    delete globalThis.endGuard;
    return hit;
  };
}

class Locator {
  #page;
  #steps;

  constructor(page, steps) {
    this.#page = page;
    this.#steps = steps;
  }

  get css() {
    return this.#steps[0].css;
  }

  locator(css, { hasText, has } = {}) {
    return new Locator(this.#page, [...this.#steps, { css, hasText, has: has?.css }]);
  }
  nth(nth) {
    return new Locator(this.#page, [...this.#steps, { nth }]);
  }
  first() {
    return this.nth(0);
  }

  async #all() {
    return this.#page.evaluateHandle(elementsOf, this.#steps);
  }

  /** Handle of the first element that passes `test`, when there is one. */
  async #wait(test, what) {
    for (const end = Date.now() + PATIENCE; Date.now() < end; await pause(30)) {
      const element = (await (await this.#all()).evaluateHandle((list) => list[0])).asElement();
      if (element && (test === null || await element.evaluate(test))) return element;
    }
    throw new Error(`${JSON.stringify(this.#steps)} was not ${what} within ${PATIENCE} ms`);
  }
  #present() {
    return this.#wait(null, 'there');
  }
  #usable() {
    return this.#wait((element) => {
      const { width, height } = element.getBoundingClientRect();
      return width > 0 && height > 0 && !element.matches(':disabled') && getComputedStyle(element).visibility === 'visible';
    }, 'visible and enabled');
  }

  async waitFor({ state = 'visible' } = {}) {
    if (state === 'attached') await this.#present();
    else await this.#wait(isShown, 'visible');
  }
  async isVisible() {
    const element = (await (await this.#all()).evaluateHandle((list) => list[0])).asElement();
    return element !== null && element.evaluate(isShown);
  }
  async evaluate(read, ...values) {
    return (await this.#present()).evaluate(read, ...values);
  }
  async evaluateAll(read) {
    return (await this.#all()).evaluate(read);
  }
  innerText() {
    return this.evaluate((element) => element.innerText);
  }
  allInnerTexts() {
    return this.evaluateAll((list) => list.map((element) => element.innerText));
  }
  getAttribute(name) {
    return this.evaluate((element, attribute) => element.getAttribute(attribute), name);
  }
  inputValue() {
    return this.evaluate((element) => element.value);
  }
  isDisabled() {
    return this.evaluate((element) => element.matches(':disabled'));
  }
  async boundingBox() {
    return (await this.#present()).boundingBox();
  }
  scrollIntoViewIfNeeded() {
    return this.evaluate((element) => element.scrollIntoView({ block: 'nearest' }));
  }

  /**
   * Clicks where the element is; once more when it has moved away in the meantime and something else would have been hit, or
   * when it has been hidden or replaced and there is nothing to hit.
   */
  async click() {
    let cause;
    for (const end = Date.now() + PATIENCE; Date.now() < end; await pause(30)) {
      const element = await this.#usable();
      try {
        await element.evaluate(guardClick);
        await element.click();
      } catch (error) {
        cause = error;
      }
      if (await this.#page.evaluate(() => globalThis.endGuard?.())) return;
    }
    throw new Error(`${JSON.stringify(this.#steps)} could not be clicked within ${PATIENCE} ms`, { cause });
  }
  async focus() {
    await (await this.#present()).focus();
  }
  async press(key) {
    await (await this.#present()).press(key);
  }
  async fill(value) {
    const element = await this.#usable();
    const isRange = await element.evaluate((input, text) => {
      input.focus();
      if (input.type !== 'range') {
        input.select();
        return false;
      }
      input.value = text;
      for (const type of ['input', 'change']) input.dispatchEvent(new Event(type, { bubbles: true }));
      return true;
    }, value);
    if (!isRange) await element.type(value);
  }
  async check() {
    if (!(await this.evaluate((input) => input.checked))) await this.click();
  }
  async uncheck() {
    if (await this.evaluate((input) => input.checked)) await this.click();
  }
  async setInputFiles(paths) {
    await (await this.#present()).uploadFile(...[paths].flat());
  }
}

export class FirefoxPage {
  #tab;
  #firefox;
  #size;

  /** @param firefox  of startFirefox(); @param tab  puppeteer's page in it */
  constructor(firefox, tab, size) {
    this.#firefox = firefox;
    this.#tab = tab;
    this.#size = size;
  }

  get keyboard() {
    return { press: (key) => this.#tab.keyboard.press(key === 'Space' ? ' ' : key) };
  }
  get mouse() {
    const { mouse } = this.#tab;
    return {
      move: (x, y, options) => mouse.move(x, y, options), down: () => mouse.down(), up: () => mouse.up(),
      wheel: (deltaX, deltaY) => mouse.wheel({ deltaX, deltaY }),
    };
  }
  viewportSize() {
    return this.#size;
  }
  async setViewportSize(size) {
    this.#size = size;
    await this.#tab.setViewport(size);
  }

  locator(css, { hasText, has } = {}) {
    return new Locator(this, [{ css, hasText, has: has?.css }]);
  }
  getByRole(role, { name }) {
    return this.locator(role, { hasText: name });
  }
  evaluate(read, ...values) {
    return this.#tab.evaluate(read, ...values);
  }
  evaluateHandle(read, ...values) {
    return this.#tab.evaluateHandle(read, ...values);
  }
  waitForFunction(test, value, { timeout = PATIENCE } = {}) {
    return this.#tab.waitForFunction(test, { timeout }, value);
  }
  waitForTimeout(milliseconds) {
    return pause(milliseconds);
  }
  title() {
    return this.#tab.title();
  }
  workers() {
    return this.#tab.workers();
  }
  goto(url) {
    return this.#tab.goto(url);
  }
  reload() {
    return this.#tab.reload();
  }
  pdf(options) {
    return this.#tab.pdf(options).then((bytes) => Buffer.from(bytes));
  }
  screenshot(options) {
    return this.#tab.screenshot(options);
  }

  async waitForEvent(name) {
    if (name !== 'filechooser') throw new Error(`the page in Firefox does not wait for ${name}`);
    const chooser = await this.#tab.waitForFileChooser();
    return { setFiles: (paths) => chooser.accept([paths].flat()) };
  }

  /** Drops files or folders of the disk onto the middle of the page, through the screen. */
  async dropFiles(paths, { hanging } = {}) {
    const [left, top] = await this.evaluate(() => [globalThis.mozInnerScreenX, globalThis.mozInnerScreenY]);
    const { width, height } = this.#size;
    await this.#tab.bringToFront();
    await dragFiles(this.#firefox.display, paths, { x: Math.round(left + width / 2), y: Math.round(top + height / 2), hanging });
  }

  /** Two fingers go apart from `gap` to `wider` pixels around a place. */
  async spreadFingers([x, y], gap, wider) {
    const { touchscreen } = this.#tab;
    const left = await touchscreen.touchStart(x - gap / 2, y), right = await touchscreen.touchStart(x + gap / 2, y);
    for (let i = 1; i <= 6; ++i) {
      const reach = (gap + (wider - gap) * i / 6) / 2;
      await left.move(x - reach, y);
      await right.move(x + reach, y);
    }
    await left.end();
    await right.end();
  }

  /** Runs a script past the page's policy. */
  async inject(script) {
    await this.#tab.evaluate(script);
  }

  /** Clicks a link that downloads; { name, bytes } of the file. */
  async save(selector) {
    const { downloads } = this.#firefox;
    await this.locator(selector).click();
    for (const end = Date.now() + PATIENCE; Date.now() < end; await pause(30)) {
      const files = readdirSync(downloads);
      // While it is written there is an empty file of its name beside a partial one.
      if (files.length !== 1 || files[0].endsWith('.part')) continue;
      const path = join(downloads, files[0]);
      const bytes = readFileSync(path);
      if (bytes.length === 0) continue;
      rmSync(path);
      return { name: files[0], bytes };
    }
    const address = await this.locator(selector).evaluate((link) => link.href);
    throw new Error(`${selector} (${address}) was not downloaded within ${PATIENCE} ms; there are [${readdirSync(downloads)}]`);
  }
}

/**
 * Opens a page in a tab that goes when the test `t` ends, and watches it; see openPage() of page_helpers.mjs.
 * @param firefox  of startFirefox()
 * @param seen     { trouble, requests }, filled from now on
 */
export async function openFirefoxPage(t, firefox, url, seen, { width, height }) {
  const tab = await firefox.browser.newPage();
  t.after(() => tab.close());
  tab.on('console', (message) => { if (['error', 'warn'].includes(message.type())) seen.trouble.push(`console: ${message.text()}`); });
  tab.on('pageerror', (error) => seen.trouble.push(`exception: ${error.message}`));
  tab.on('request', (request) => seen.requests.push(request.url()));
  tab.on('response', (response) => {
    seen.headers.set(response.url(), response.headers());
    if (response.status() >= 400) seen.trouble.push(`HTTP ${response.status()}: ${response.url()}`);
  });
  await tab.evaluateOnNewDocument(() => {
    addEventListener('securitypolicyviolation', (event) => console.error(`policy violated: ${event.violatedDirective} ${event.blockedURI}`));
  });
  await tab.setViewport({ width, height });
  await tab.goto(url);
  return new FirefoxPage(firefox, tab, { width, height });
}
