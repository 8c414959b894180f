// SPDX-License-Identifier: MIT
// Keys from passphrases: a fixed answer, so that a passphrase opens the same marks for ever.
import assert from 'node:assert/strict';
import { scrypt } from 'node:crypto';
import { test } from 'node:test';
import { promisify } from 'node:util';
import { parseKey } from 'quadmark';
import { keyFromPassphrase, LEAST_PASSPHRASE } from 'quadmark/passphrase';

const derive = (request) => keyFromPassphrase(request, (password, salt, { N, r, p, dkLen }) =>
  promisify(scrypt)(password, salt, dkLen, { N, r, p, maxmem: 2 ** 28 }));

test('a passphrase and an owner always give the same key', async () => {
  const key = await derive({ passphrase: 'correct horse battery staple', owner: 'Example Studio' });
  assert.deepEqual(key, { quadmark: 1, scheme: 'robust', secret: '4TDoIpFVhgBGsRLyo9CUzQgOECqkitgRNEVTDAqxky8=', owner: 'Example Studio' });
  assert.deepEqual(await parseKey(key), key);
  const others = await Promise.all([{ passphrase: 'correct horse battery staple' }, { passphrase: 'Correct horse battery staple', owner: 'Example Studio' }].map(derive));
  assert.equal(new Set([key, ...others].map(({ secret }) => secret)).size, 3);
});

test('however its letters are composed', async () => {
  const [composed, decomposed] = await Promise.all(['NFC', 'NFD'].map((form) => derive({ passphrase: 'Grüße aus Köln!'.normalize(form), owner: 'Söhne'.normalize(form) })));
  assert.deepEqual(composed, decomposed);
});

test('short ones are refused before any work', async () => {
  await assert.rejects(keyFromPassphrase({ passphrase: 'x'.repeat(LEAST_PASSPHRASE - 1) }, () => assert.fail('called')), { code: 'bad_key', message: /at least 12 characters .* 11 were given/ });
});
