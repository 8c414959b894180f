// SPDX-License-Identifier: MIT
// Marks for many recipients: lists, IDs, registries, and whose copy a leaked one is.
import assert from 'node:assert/strict';
import { createHmac } from 'node:crypto';
import { existsSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey, embed, keyFingerprint, recipientId, trace } from 'quadmark';
import { attack } from 'quadmark/lab';
import { parseRecipients, parseRegistry, registryLine } from 'quadmark/recipients';
import { quadmark, realModel, temporaryFolder } from './support/files.mjs';
import { splitGlb } from './support/gltf.mjs';
import { fixedRobustKey, logo, logoPng, sculpture } from './support/marks.mjs';

const glb = await sculpture('glb', 4000);
const key = await fixedRobustKey();
const fails = (work, code, message) => assert.rejects(async () => work(), (error) => error.code === code && message.test(error.message));

async function workspace(t, csv, files = {}) {
  const folder = temporaryFolder(t);
  for (const [name, bytes] of Object.entries({ 'in.glb': glb, 'key.json': JSON.stringify(key), 'list.csv': csv, ...files })) {
    writeFileSync(join(folder, name), bytes);
  }
  const cli = (args, options) => quadmark(args, { cwd: folder, ...options });
  const mark = (...more) => cli(['embed', 'in.glb', '--recipients', 'list.csv', '--out-dir', 'out', '--registry', 'reg.jsonl', '--key', 'key.json', ...more]);
  const traced = (name, ...more) => cli(['trace', name, '--registry', 'reg.jsonl', '--key', 'key.json', ...more]);
  const read = (name) => readFileSync(join(folder, name));
  return { folder, cli, mark, traced, read, entries: () => parseRegistry(read('reg.jsonl').toString()).entries };
}

test('an ID is HKDF-SHA256 of the secret and the name, as the format says', async () => {
  const info = Buffer.concat([Buffer.from('quadmark/recipient/v1\0Çelik'), Buffer.from([1])]);
  const hmac = (secret, data) => createHmac('sha256', secret).update(data).digest();
  const expected = hmac(hmac(Buffer.alloc(32), Buffer.from(key.secret, 'base64')), info).subarray(0, 8).toString('hex');
  assert.equal(await recipientId(key, 'Çelik'), expected);
  assert.equal(await recipientId(JSON.stringify(key), ' C\u0327elik '), expected, 'spelling in Unicode does not matter');
  assert.notEqual(await recipientId(await createKey(), 'Çelik'), expected);
  assert.match(await keyFingerprint(key), /^[0-9a-f]{16}$/);
  await fails(() => recipientId(key, ' '), 'bad_option', /empty/);
  await fails(() => recipientId(key, 'a\nb'), 'bad_option', /control characters/);
  await fails(() => recipientId(key, 'x'.repeat(257)), 'bad_option', /257 bytes/);
});

test('lists may have quotes, a BOM, CRLF and other columns', () => {
  assert.deepEqual(parseRecipients('\ufeffRecipient,note,Folder\r\n"Alice ""A"", Inc.","two\r\nlines",a\r\n\r\n Bob ,,\r\n'),
    [{ recipient: 'Alice "A", Inc.', folder: 'a', line: 3 }, { recipient: 'Bob', line: 5 }]);
});

test('what is wrong with a list is said with its line', () => {
  for (const [csv, message] of [
    ['', /list, line 1: the list is empty/],
    ['name\nBob\n', /line 1: no column recipient/],
    ['recipient,recipient\nBob,Bob\n', /line 1: the column recipient is there twice/],
    ['recipient\n', /line 1: nobody/],
    ['recipient\nBob\nAlice\nBob\n', /line 4: "Bob" is already on line 2/],
    ['recipient\nC\u0327elik\n\u00c7elik\n', /line 3: .* already on line 2/],
    ['recipient,note\nBob\n', /line 2: 1 values, but the header has 2 columns/],
    ['recipient\n"Bob\n', /line 2: Quote Not Closed/],
    ['recipient\n"Bob"by\n', /line 2: Invalid Closing Quote/],
    ['recipient,note\n,x\n', /line 2: recipient: empty/],
  ]) assert.throws(() => parseRecipients(csv), (error) => error.code === 'bad_file' && message.test(error.message), csv);
});

test('every recipient gets a copy, and each copy names its recipient', async (t) => {
  const { mark, traced, entries, read, folder } = await workspace(t, 'recipient\r\n"Alice, Inc."\r\nBob\r\nÇelik 3D\r\n');
  const marked = await mark('--json', '--jobs', '2');
  assert.equal(marked.status, 0, marked.stderr);
  assert.deepEqual(marked.json.map(({ recipient, output }) => [recipient, output]),
    [['Alice, Inc.', 'out/Alice, Inc/in.glb'], ['Bob', 'out/Bob/in.glb'], ['Çelik 3D', 'out/Çelik 3D/in.glb']]);
  assert.deepEqual(new Set(entries().map(({ id }) => id)), new Set(marked.json.map(({ id }) => id)));
  assert.equal(existsSync(join(folder, 'reg.jsonl.lock')), false);
  assert.equal(read('reg.jsonl').includes(key.secret), false);

  for (const { recipient, output } of marked.json) {
    const found = await traced(output, '--json');
    assert.equal(found.status, 0, found.stderr);
    const [{ verdict, recipient: named, falsePositive, trials, method, copies }] = found.json;
    assert.deepEqual([verdict, named, trials, method, copies.length], ['match', recipient, 3, 'read', 1]);
    assert.ok(falsePositive <= 1e-6);
  }
  const none = await traced('in.glb', '--json');
  assert.deepEqual([none.status, none.json[0].verdict, none.json[0].recipient], [3, 'none', null]);
  assert.match((await traced('out/Bob/in.glb')).stdout.toString(), /Bob\n.*with 3 candidates/);

  const before = read('reg.jsonl');
  const again = await mark('--json');
  assert.deepEqual([again.status, ...again.json.map(({ alreadyDone }) => alreadyDone)], [0, true, true, true], 'what is done is not done again');
  assert.deepEqual(read('reg.jsonl'), before);
});

test('a mark of the key that is nobody\'s is not pinned on anyone', async (t) => {
  const { cli, mark, traced } = await workspace(t, 'recipient\nAlice\nBob\n');
  assert.equal((await mark()).status, 0);
  assert.equal((await cli(['embed', 'in.glb', 'other.glb', '--id', 'C0FFEE', '--key', 'key.json'])).status, 0);
  const { status, json: [{ verdict, recipient, id }] } = await traced('other.glb', '--json');
  assert.deepEqual([status, verdict, recipient, id], [3, 'none', null, '0000000000c0ffee']);
});

test('a mark too faint to be read still names its recipient among few', async () => {
  const names = ['Alice', 'Bob', 'Carol', 'Dave'];
  const candidates = await Promise.all(names.map(async (recipient) => ({ recipient, id: await recipientId(key, recipient) })));
  const { bytes } = await embed(await sculpture('glb', 12000), { key, id: candidates[1].id });
  const methods = new Set();
  for (let amount = 0.001; amount < 0.004; amount += 0.00025) {
    const damaged = (await attack(bytes, { kind: 'noise', amount, seed: 7 })).bytes;
    let compared = 0;
    const { verdict, recipient, falsePositive, method, trials, candidates: [best] } = await trace(damaged, { key, candidates, options: { onCandidate: ({ done }) => { compared = done; } } });
    if (verdict !== 'match') break;
    assert.deepEqual([recipient, trials, compared], ['Bob', 4, method === 'compared' ? 4 : 0]);
    assert.ok(falsePositive <= 1e-6);
    assert.equal(falsePositive, best.falsePositive * (method === 'compared' ? 4 : 1), 'each question is one more chance to be wrong');
    methods.add(method);
  }
  assert.deepEqual([...methods], ['read', 'compared']);
});

test('a blind reading is as certain among many candidates as among few', async () => {
  const id = await recipientId(key, 'Bob');
  const { bytes } = await embed(glb, { key, id });
  const others = (count) => Array.from({ length: count }, (_, i) => ({ recipient: `other ${i}`, id: BigInt(i) }));
  const few = await trace(bytes, { key, candidates: [{ recipient: 'Bob', id }, ...others(9), ...others(9)] });
  assert.equal(few.trials, 10, 'equal candidates count once');
  assert.deepEqual([few.recipient, few.falsePositive], ['Bob', few.candidates[0].falsePositive]);
  const salted = await trace(bytes, { key, candidates: [{ recipient: 'Bob', id }, { recipient: 'Eve', id, salt: 'other' }] });
  assert.deepEqual([salted.recipient, salted.falsePositive], ['Bob', salted.candidates[0].falsePositive * 2], 'two salts are two readings');
  await fails(() => trace(bytes, { key, candidates: [{ recipient: 'Bob', id }, { recipient: 'Eve', id }] }), 'bad_option', /"Bob" and "Eve" have the same mark/);
  await fails(() => trace(bytes, { key, candidates: [] }), 'bad_option', /nobody/);
  await fails(() => trace(bytes, { key, candidates: [{ recipient: 'Bob' }] }), 'bad_option', /either id or image/);
});

test('logos instead of IDs, told apart even where they are alike', async (t) => {
  const one = logo(), two = { ...logo(), bits: logo().bits.map((bit, i) => (i >= 200 && i < 240 ? 1 - bit : bit)) };
  const csv = 'recipient,image\nAlice,one.png\nBob,two.png\n';
  const large = await sculpture('glb', 20000);
  for (const scheme of ['robust', 'paper']) {
    const chosen = scheme === 'robust' ? key : await createKey({ width: 24, height: 24 });
    const { mark, traced, entries, cli } = await workspace(t, csv, { 'in.glb': large, 'one.png': logoPng(one), 'two.png': logoPng(two), 'key.json': JSON.stringify(chosen) });
    const marked = await mark();
    assert.equal(marked.status, 0, marked.stderr);
    assert.deepEqual(entries()[1].image.bits, two.bits);
    assert.equal((await cli(['attack', 'out/Bob/in.glb', 'crop.glb', '--kind', 'crop', '--amount', '0.2'])).status, 0);
    for (const [name, expected] of [['out/Alice/in.glb', 'Alice'], ['out/Bob/in.glb', 'Bob'], ['crop.glb', 'Bob']]) {
      const found = await traced(name, '--json');
      assert.deepEqual([found.status, found.json[0].recipient], [0, expected], `${scheme}: ${name}`);
    }
    assert.equal((await traced('in.glb')).status, 3);
  }
});

test('keys of scheme paper trace IDs', async () => {
  const paper = await createKey({ id: true });
  const candidates = await Promise.all(['Alice', 'Bob', 'Carol'].map(async (recipient) => ({ recipient, id: await recipientId(paper, recipient) })));
  const { bytes } = await embed(glb, { key: paper, id: candidates[2].id });
  const { verdict, recipient, falsePositive } = await trace(bytes, { key: paper, candidates });
  assert.deepEqual([verdict, recipient], ['match', 'Carol']);
  assert.ok(falsePositive < 1e-6);
  assert.equal((await trace(glb, { key: paper, candidates })).verdict, 'none');
});

test('a salt goes into the registry, and tracing takes it from there', async (t) => {
  const { mark, traced, entries } = await workspace(t, 'recipient\nAlice\nBob\n');
  assert.equal((await mark('--salt', 'chair')).status, 0);
  assert.equal((await mark('--out-dir', 'more', '--salt', 'table')).status, 0);
  assert.deepEqual(entries().map(({ salt }) => salt), ['chair', 'chair', 'table', 'table']);
  const { recipient, trials } = (await traced('more/Bob/in.glb', '--json')).json[0];
  assert.deepEqual([recipient, trials], ['Bob', 4]);
  assert.equal((await traced('more/Bob/in.glb', '--salt', 'chair')).status, 3);
  assert.equal((await traced('more/Bob/in.glb', '--salt', 'lamp')).status, 2);
});

test('a dry run marks for everybody and leaves nothing', async (t) => {
  const { mark, folder } = await workspace(t, 'recipient\nAlice\nBob\n');
  const before = readdirSync(folder);
  const dry = await mark('--dry-run', '--json');
  assert.deepEqual([dry.status, ...dry.json.map(({ recipient, dryRun }) => [recipient, dryRun])], [0, ['Alice', true], ['Bob', true]]);
  assert.deepEqual(readdirSync(folder), before);
});

test('the buffers of a .gltf go into each recipient\'s folder', async (t) => {
  const { gltf, bin } = splitGlb(glb, 'data.bin');
  const { cli, folder, traced } = await workspace(t, 'recipient,folder\nAlice,a\nBob,b\n', { 'in.gltf': gltf, 'data.bin': bin });
  const { status, stderr } = await cli(['embed', 'in.gltf', '--recipients', 'list.csv', '--out-dir', 'out', '--registry', 'reg.jsonl', '--key', 'key.json']);
  assert.equal(status, 0, stderr);
  assert.deepEqual(readdirSync(join(folder, 'out/b')).sort(), ['data.bin', 'in.gltf']);
  assert.equal((await traced('out/b/in.gltf', '--json')).json[0].recipient, 'Bob');
});

test('wrong use is refused with the reason, and leaves nothing', async (t) => {
  const { mark, cli, folder, read } = await workspace(t, 'recipient\nAlice\nAlice\n');
  const refused = async (work, status, message) => {
    const result = await work;
    assert.equal(result.status, status, result.stderr);
    assert.match(result.stderr, message);
  };
  await refused(mark(), 1, /list\.csv, line 3: "Alice" is already on line 2/);
  await refused(cli(['embed', 'in.glb', '--recipients', 'list.csv', '--out-dir', 'out', '--key', 'key.json']), 2, /needs --registry/);
  await refused(mark('--id', '1'), 2, /exactly one of/);
  await refused(cli(['embed', 'in.glb', 'o.glb', '--id', '1', '--registry', 'r', '--key', 'key.json']), 2, /goes with --recipients/);
  assert.deepEqual(readdirSync(folder).sort(), ['in.glb', 'key.json', 'list.csv']);

  writeFileSync(join(folder, 'list.csv'), 'recipient,folder\nAlice,../up\n');
  await refused(mark(), 1, /line 2: "\.\.\/up" is not the name of one folder/);
  writeFileSync(join(folder, 'list.csv'), 'recipient\na/b\na:b\n');
  await refused(mark(), 1, /line 3: the folder "a-b" is that of line 2 too/);
  writeFileSync(join(folder, 'list.csv'), 'recipient,image\nAlice,absent.png\n');
  await refused(mark(), 1, /list\.csv, line 2: cannot read .*absent\.png/);
  writeFileSync(join(folder, 'list.csv'), 'recipient,image\nAlice,key.json\n');
  await refused(mark(), 1, /list\.csv, line 2: key\.json: PNG/);
  writeFileSync(join(folder, 'list.csv'), Buffer.from('recipient\nJos\xe9\n', 'latin1'));
  await refused(mark(), 1, /not UTF-8/);

  writeFileSync(join(folder, 'list.csv'), 'recipient\nAlice\n');
  const entry = { recipient: 'Mallory', id: await recipientId(key, 'Alice'), key: await keyFingerprint(key), scheme: 'robust', model: 'x', output: 'y', time: 'z' };
  writeFileSync(join(folder, 'reg.jsonl'), registryLine(entry));
  await refused(mark(), 2, /list\.csv, line 2: "Alice" would get the mark of "Mallory"/);
  writeFileSync(join(folder, 'reg.jsonl'), 'nonsense\n');
  await refused(mark(), 1, /reg\.jsonl, line 1: not JSON/);
  assert.equal(read('reg.jsonl').toString(), 'nonsense\n', 'it is left as it was');
  writeFileSync(join(folder, 'reg.jsonl'), '{"quadmarkRegistry":2}\n');
  await refused(mark(), 1, /registry format 2/);
  await refused(cli(['trace', 'in.glb', '--registry', 'absent.jsonl', '--key', 'key.json']), 1, /absent\.jsonl: no such file/);
  writeFileSync(join(folder, 'reg.jsonl'), registryLine({ ...entry, key: '0'.repeat(16) }));
  await refused(cli(['trace', 'in.glb', '--registry', 'reg.jsonl', '--key', 'key.json']), 1, /none of 1 entries is of this key/);
  assert.equal(existsSync(join(folder, 'out')), false);
});

test('a registry that a killed run left torn is repaired; one in use is not touched', async (t) => {
  const { mark, entries, folder, read } = await workspace(t, 'recipient\nAlice\n');
  assert.equal((await mark()).status, 0);
  const whole = read('reg.jsonl').toString();
  writeFileSync(join(folder, 'reg.jsonl'), `${whole}{"quadmarkRegistry":1,"recipient":"Çe`);
  writeFileSync(join(folder, 'reg.jsonl.lock'), `${process.pid} another-machine\n`);
  const locked = await mark('--force');
  assert.equal(locked.status, 1);
  assert.match(locked.stderr, /in use by process/);
  writeFileSync(join(folder, 'reg.jsonl.lock'), `${2 ** 22 + 1} ${(await import('node:os')).hostname()}\n`);
  writeFileSync(join(folder, 'list.csv'), 'recipient\nAlice\nBob\n');
  const { status, stderr } = await mark();
  assert.equal(status, 0, stderr);
  assert.ok(read('reg.jsonl').toString().startsWith(whole));
  assert.deepEqual(entries().map(({ recipient }) => recipient), ['Alice', 'Bob']);
});

test('a run killed anywhere leaves whole copies, each in the registry, and the next one finishes', { timeout: 120000 }, async (t) => {
  const names = Array.from({ length: 12 }, (_, i) => `studio ${i}`);
  const { folder, mark, entries, read } = await workspace(t, `recipient\n${names.join('\n')}\n`);
  const { spawn } = await import('node:child_process');
  const { cliFile } = await import('./support/files.mjs');
  const copies = () => (existsSync(join(folder, 'out')) ? readdirSync(join(folder, 'out')) : [])
    .filter((name) => existsSync(join(folder, 'out', name, 'in.glb')));
  for (const wanted of [1, 5, 9]) {
    const child = spawn(process.execPath, [cliFile, 'embed', 'in.glb', '--recipients', 'list.csv', '--out-dir', 'out', '--registry', 'reg.jsonl', '--key', 'key.json'], { cwd: folder, stdio: 'ignore' });
    const ended = new Promise((resolve) => child.on('exit', resolve));
    while (copies().length < wanted && child.exitCode === null) await new Promise((resolve) => setTimeout(resolve, 2));
    child.kill('SIGKILL');
    await ended;
    const { createHash } = await import('node:crypto');
    const known = new Map(entries().map(({ recipient, outputSha256 }) => [recipient, outputSha256]));
    for (const name of copies()) {
      assert.equal(createHash('sha256').update(read(join('out', name, 'in.glb'))).digest('hex'), known.get(name), `${name} is whole and known`);
    }
  }
  const { status, stderr } = await mark();
  assert.equal(status, 0, stderr);
  assert.deepEqual(copies().sort(), [...names].sort());
  assert.equal(new Set(entries().map(({ recipient }) => recipient)).size, names.length);
});

test('real models are traced too', async (t) => {
  for (const name of ['Duck.glb', 'bunny.glb']) {
    const path = realModel(t, name);
    if (path === null) continue;
    const { mark, traced } = await workspace(t, 'recipient\nAlice\nBob\n', { 'in.glb': readFileSync(path) });
    const marked = await mark();
    assert.equal(marked.status, 0, marked.stderr);
    assert.equal((await traced('out/Bob/in.glb', '--json')).json[0].recipient, 'Bob', name);
  }
});
