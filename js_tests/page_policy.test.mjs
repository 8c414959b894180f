// SPDX-License-Identifier: MIT
// The page's content security policy, the server that sends it, and that the other tests' watch sees violations.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import { request } from 'node:http';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { HEADER_POLICY, PAGE_POLICY, servePage } from '../web/serve.mjs';
import { assertQuiet, openPage, pageRoot, shown, startBrowsers, waitFor } from './page_helpers.mjs';
import { repository, run, temporaryFolder } from './support/files.mjs';

const { inEach, inChromium } = await startBrowsers(after);

/** One request with the path exactly as given: fetch would tidy it. */
function ask(url, path, { method = 'GET' } = {}) {
  return new Promise((resolve, reject) => {
    const { hostname, port } = new URL(url);
    request({ hostname, port, path, method }, (response) => {
      const chunks = [];
      response.on('data', (chunk) => chunks.push(chunk));
      response.on('end', () => resolve({ status: response.statusCode, headers: response.headers, body: Buffer.concat(chunks) }));
    }).on('error', reject).end();
  });
}

test('header and page hold one policy, without eval and inline code', () => {
  const html = readFileSync(join(pageRoot, 'index.html'), 'utf8');
  const [, inPage] = /http-equiv="Content-Security-Policy" content="([^"]*)"/.exec(html);
  assert.equal(inPage, PAGE_POLICY);
  assert.equal(HEADER_POLICY, `${PAGE_POLICY}; frame-ancestors 'none'`);
  const directives = Object.fromEntries(PAGE_POLICY.split('; ').map((part) => {
    const [name, ...sources] = part.split(' ');
    return [name, sources.join(' ')];
  }));
  assert.deepEqual(directives, {
    'default-src': "'none'", 'script-src': "'self' 'wasm-unsafe-eval'", 'worker-src': "'self'", 'connect-src': "'self'",
    'style-src': "'self'", 'img-src': "'self' blob: data:", 'base-uri': "'none'", 'form-action': "'none'",
  });
  assert.doesNotMatch(html, /<script(?![^>]*\ssrc=)|<style|\sstyle=|\son[a-z]+=/i);
});

inChromium('everything is sent with the policy and its right type, the worker script too', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  await page.locator('[data-sample="marked"]').click();
  await waitFor(page, 'match');
  const types = { '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.glb': 'model/gltf-binary', '.json': 'application/json', '.svg': 'image/svg+xml' };
  const files = [...seen.headers].filter(([url]) => url.startsWith(browser.url));
  assert.ok(files.filter(([url]) => url.endsWith('.js')).length >= 2, 'the page\'s script and the worker\'s');
  for (const extension of ['.js', '.css', '.wasm', '.glb', '.json']) {
    assert.ok(files.some(([url]) => url.endsWith(extension)), `${extension} was asked for`);
  }
  for (const [url, headers] of files) {
    assert.equal(headers['content-security-policy'], HEADER_POLICY, url);
    assert.equal(headers['x-content-type-options'], 'nosniff', url);
    const extension = /\.[a-z]+$/.exec(new URL(url).pathname)?.[0];
    if (extension in types) assert.ok(headers['content-type'].startsWith(types[extension]), `${url}: ${headers['content-type']}`);
  }
});

inEach('code from strings, inline code and other origins are refused, and the watch sees it', async (t, browser) => {
  const { page, seen } = await openPage(t, browser);
  const reached = await page.evaluate(async () => {
    const attempts = {};
    const inline = document.createElement('script');
    inline.textContent = 'globalThis.inlineRan = true';
    document.head.append(inline);
    attempts.inline = globalThis.inlineRan === true;
    attempts.eval = await new Promise((resolve) => {
      addEventListener('quadmark-test', () => {
        try {
          resolve(new Function('return true')());
        } catch {
          resolve(false);
        }
      }, { once: true });
      setTimeout(() => dispatchEvent(new Event('quadmark-test')));
    });
    attempts.fetch = await fetch('https://example.invalid/').then(() => true, () => false);
    attempts.image = await new Promise((resolve) => {
      const image = new Image();
      image.onload = () => resolve(true);
      image.onerror = () => resolve(false);
      image.src = 'https://example.invalid/x.png';
    });
    return attempts;
  });
  assert.deepEqual(reached, { inline: false, eval: false, fetch: false, image: false });
  for (const directive of [/policy violated: script-src-elem inline/, /policy violated: script-src eval/, /policy violated: connect-src https:\/\/example\.invalid/, /policy violated: img-src https:\/\/example\.invalid/]) {
    assert.ok(seen.trouble.some((line) => directive.test(line)), `${directive} in ${seen.trouble.join('\n')}`);
  }
});

inEach('the page works from a folder below the root of a server', async (t, browser) => {
  const { server, url } = await servePage({ root: join(pageRoot, '..') });
  t.after(() => {
    server.close();
    server.closeAllConnections();
  });
  const { page, seen } = await openPage(t, { ...browser, url }, { path: 'dist/' });
  await page.locator('[data-sample="marked"]').click();
  await waitFor(page, 'match');
  assertQuiet(seen, url);
  assert.deepEqual(seen.requests.filter((request) => request.startsWith(url) && !request.startsWith(`${url}dist/`)), []);
});

inChromium('a detector or a sample that cannot be loaded is said, and may be tried again', async (t, browser) => {
  const { page } = await openPage(t, browser);
  for (const [pattern, title] of [[/\.wasm$/, 'The page could not load its detector.'], [/\/assets\/index-[^/]*\.js$/, 'The page hit a fault of its own.']]) {
    await page.reload();
    await browser.context.route(pattern, (route) => route.fulfill({ status: 404, body: 'gone' }));
    await page.locator('[data-sample="marked"]').click();
    await waitFor(page, 'problem');
    assert.equal((await shown(page)).title, title);
    await browser.context.unroute(pattern);
    await page.locator('#check').click();
    await waitFor(page, 'match');
  }
  await browser.context.route(/\/key-[^/]*\.json$/, (route) => route.fulfill({ status: 500, body: 'no' }));
  t.after(() => browser.context.unroute(/\/key-[^/]*\.json$/));
  await page.reload();
  await page.locator('[data-sample="marked"]').click();
  await page.locator('#notices li').waitFor();
  assert.deepEqual((await shown(page)).notices, ['The sample could not be loaded (key.json: HTTP status 500).']);
});

test('paths out of the folder, links out of it and other methods are refused', async (t) => {
  const folder = temporaryFolder(t);
  const root = join(folder, 'site');
  mkdirSync(join(root, 'sub'), { recursive: true });
  writeFileSync(join(folder, 'secret.txt'), 'secret');
  writeFileSync(join(root, 'index.html'), '<!doctype html>hello');
  writeFileSync(join(root, 'sub/a b.txt'), 'inside');
  symlinkSync(join(folder, 'secret.txt'), join(root, 'link.txt'));
  const { server, url } = await servePage({ root });
  t.after(() => server.close());
  assert.equal((await ask(url, '/')).body.toString(), '<!doctype html>hello');
  assert.equal((await ask(url, '/index.html?x=1')).status, 200);
  const inside = await ask(url, '/sub/a%20b.txt');
  assert.deepEqual([inside.status, inside.body.toString(), inside.headers['content-length']], [200, 'inside', '6']);
  for (const path of ['/../secret.txt', '/%2e%2e/secret.txt', '/..%2fsecret.txt', '/sub/../../secret.txt', '/sub/%2e%2e/%2e%2e/secret.txt',
    '/..\\secret.txt', '/%5c..%5csecret.txt', '/%00', '/%zz', '//etc/passwd', '/link.txt', '/sub', '/sub/', '/none.txt', 'http://x/../secret.txt']) {
    const { status, body, headers } = await ask(url, path);
    assert.ok(status === 400 || status === 404, `${path}: ${status}`);
    assert.doesNotMatch(body.toString(), /secret|root:/, path);
    assert.equal(headers['content-security-policy'], HEADER_POLICY, path);
  }
  const head = await ask(url, '/', { method: 'HEAD' });
  assert.deepEqual([head.status, head.body.length, head.headers['content-length']], [200, 0, '20']);
  for (const method of ['POST', 'PUT', 'DELETE', 'OPTIONS']) {
    const refused = await ask(url, '/', { method });
    assert.deepEqual([refused.status, refused.headers.allow], [405, 'GET, HEAD'], method);
  }
  assert.equal(server.address().address, '127.0.0.1');
});

test('the server says what is wrong when there is nothing to serve', async (t) => {
  const serve = join(repository, 'web/serve.mjs');
  const empty = await run(process.execPath, [serve, '--root', temporaryFolder(t)]);
  assert.equal(empty.status, 1);
  assert.match(empty.stderr, /^serve: .* has no index\.html: build the page first/);
  const port = await run(process.execPath, [serve, '--port', 'http']);
  assert.equal(port.status, 1);
  assert.match(port.stderr, /--port: expected 0 to 65535, got http/);
});
