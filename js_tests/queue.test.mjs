// SPDX-License-Identifier: MIT
// The queue with a real Redis and worker processes. What killing them does is in queue_kill.test.mjs.
import assert from 'node:assert/strict';
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { createKey, embed, extract } from 'quadmark';
import { connect, enqueue, fromList, retryDead, runStatus } from 'quadmark-queue';
import { realModel, temporaryFolder } from './support/files.mjs';
import { splitGlb } from './support/gltf.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';
import { expectedOutputs, queueFolders, writeModels } from './support/queue.mjs';
import { hasRedis, queueCommand, startRedis, startWorkerProcess } from './support/redis.mjs';
import { until } from './support/server.mjs';

const needsRedis = { skip: hasRedis ? false : 'no redis-server', timeout: 240_000 };
const glb = await sculpture('glb', 3000);

async function start(t, { work = true } = {}) {
  const redis = await startRedis();
  const folders = await queueFolders(t);
  const workers = [];
  t.after(async () => {
    await Promise.all(workers.map((worker) => worker.kill()));
    await redis.stop();
  });
  const startWorker = async (options) => {
    workers.push(await startWorkerProcess(redis, { ...folders, ...options }));
    return workers.at(-1);
  };
  const worker = work ? await startWorker() : null;
  const command = (...args) => queueCommand(redis, args);
  const add = (source, ...args) =>
    command('add', '--json', ...source, '--out', folders.outRoot, '--key', folders.keyFile, '--wait', ...args);
  return { redis, ...folders, worker, startWorker, command, add };
}

const reportOf = ({ outRoot }, { report }) => JSON.parse(readFileSync(join(outRoot, report), 'utf8'));
const marked = (outRoot) => readdirSync(outRoot).filter((name) => !name.endsWith('.json')).sort();

test('a folder is marked once, however often it is queued', needsRedis, async (t) => {
  const at = await start(t);
  await writeModels(at.inRoot, 4);
  for (const name of ['fandisk.glb', 'rocker-arm.ply']) {
    const path = realModel(t, name);
    if (path) copyFileSync(path, join(at.inRoot, name));
  }
  writeFileSync(join(at.inRoot, 'notes.txt'), 'no model');
  const expected = await expectedOutputs(at.inRoot, at.key, 'c0ffee');
  const names = Object.keys(expected).sort();
  const first = await at.add(['--folder', at.inRoot], '--id', 'C0FFEE');
  assert.equal(first.status, 0, first.stderr);
  assert.equal(first.json[0].added, names.length);
  assert.equal(first.json[0].marked, names.length);
  assert.deepEqual(marked(at.outRoot), names);
  for (const name of names) assert.ok(readFileSync(join(at.outRoot, name)).equals(expected[name]), name);
  const report = reportOf(at, first.json[0]);
  assert.deepEqual(report.results.map(({ input }) => input), names);
  for (const { status, report: told, outputs, attempts } of report.results) {
    assert.equal(status, 'marked');
    assert.equal(told.scheme, 'robust');
    assert.equal(outputs.length, 1);
    assert.equal(attempts, 1);
  }

  // Again: nothing is done, nothing is written.
  const times = () => names.map((name) => statSync(join(at.outRoot, name)).mtimeMs);
  const before = times();
  const again = await at.add(['--folder', at.inRoot], '--id', 'c0ffee');
  assert.deepEqual([again.status, again.json[0].added, again.json[0].marked], [0, 0, names.length]);
  assert.deepEqual(times(), before);
  assert.equal(at.worker.lines().length, names.length);

  // One was lost, one damaged, one changed, one is new: these and no others.
  rmSync(join(at.outRoot, names[0]));
  writeFileSync(join(at.outRoot, names[1]), 'damaged');
  writeFileSync(join(at.inRoot, names[2]), await sculpture('glb', 3500));
  writeFileSync(join(at.inRoot, 'new.glb'), glb);
  const more = await at.add(['--folder', at.inRoot], '--id', 'c0ffee');
  assert.equal(more.status, 0, more.stderr);
  assert.equal(more.json[0].added, 4);
  assert.equal(at.worker.lines().length, names.length + 4);
  for (const [name, bytes] of Object.entries(await expectedOutputs(at.inRoot, at.key, 'c0ffee'))) {
    assert.ok(readFileSync(join(at.outRoot, name)).equals(bytes), name);
  }
});

test('a bucket is taken by prefix, a list by name, with pictures and texts', needsRedis, async (t) => {
  const at = await start(t);
  const detailed = await sculpture('glb', 20_000);
  for (const name of ['a/one.glb', 'a/deep/er/two.glb', 'b/three.glb']) {
    mkdirSync(join(at.inRoot, name, '..'), { recursive: true });
    writeFileSync(join(at.inRoot, name), detailed);
  }
  writeFileSync(join(at.root, 'logo.png'), logoPng(logo(16)));
  const bucket = await at.add(['--bucket', at.inRoot, '--prefix', 'a/'], '--image', join(at.root, 'logo.png'), '--strength', 'strong');
  assert.equal(bucket.status, 0, JSON.stringify(bucket.json));
  const expected = (await embed(detailed, { key: at.key, image: logo(16), options: { strength: 'strong' } })).bytes;
  for (const name of ['a/one.glb', 'a/deep/er/two.glb']) assert.ok(readFileSync(join(at.outRoot, name)).equals(expected));
  assert.ok(!existsSync(join(at.outRoot, 'b')));

  const list = join(at.root, 'list.txt');
  writeFileSync(list, '# what to mark\nb/three.glb\r\n\n');
  assert.deepEqual(await fromList(list), [{ input: 'b/three.glb', output: 'b/three.glb' }]);
  const listed = await at.add(['--list', list, '--in', at.inRoot], '--text', 'Ünï', '--salt', 'three', '--report', 'reports/text.json');
  assert.equal(listed.status, 0, listed.stderr);
  const read = await extract(readFileSync(join(at.outRoot, 'b/three.glb')), { key: at.key, options: { salt: 'three' } });
  assert.equal(read.text, 'Ünï');
  assert.equal(reportOf(at, { report: 'reports/text.json' }).marked, 1);
});

test('a glTF is written with its buffers', needsRedis, async (t) => {
  const at = await start(t);
  const { gltf, bin } = splitGlb(glb, 'data/mesh 1.bin');
  mkdirSync(join(at.inRoot, 'data'));
  writeFileSync(join(at.inRoot, 'model.gltf'), gltf);
  writeFileSync(join(at.inRoot, 'data/mesh 1.bin'), bin);
  const added = await at.add(['--folder', at.inRoot], '--id', '7');
  assert.equal(added.status, 0, JSON.stringify(added.json));
  const resources = { 'data/mesh 1.bin': readFileSync(join(at.outRoot, 'data/mesh 1.bin')) };
  assert.equal((await extract(readFileSync(join(at.outRoot, 'model.gltf')), { key: at.key, resources })).id, '0000000000000007');
  writeFileSync(join(at.inRoot, 'model2.gltf'), `${gltf} `);
  const clash = await at.add(['--folder', at.inRoot], '--id', '7');
  assert.equal(clash.status, 2);
  assert.match(clash.stderr, /would both write data\/mesh 1\.bin/);
});

test('models that cannot be marked become dead letters, in the report too, and can be tried again', needsRedis, async (t) => {
  const at = await start(t, { work: false });
  await writeModels(at.inRoot, 2);
  writeFileSync(join(at.inRoot, 'broken.glb'), 'glTF');
  writeFileSync(join(at.inRoot, 'tiny.ply'), await sculpture('ply', 60));
  // A worker without the key marks nothing; its failure does not pass by trying again.
  const elsewhere = join(at.root, 'elsewhere');
  renameSync(at.keys, elsewhere);
  mkdirSync(at.keys);
  writeFileSync(join(at.keys, 'another.json'), JSON.stringify(await createKey()));
  writeFileSync(join(at.keys, 'no-key.json'), '{');
  const keyFile = join(elsewhere, 'studio.json');
  await at.startWorker();
  const added = await at.command('add', '--json', '--folder', at.inRoot, '--out', at.outRoot, '--key', keyFile, '--id', '1', '--wait');
  assert.equal(added.status, 1);
  assert.deepEqual([added.json[0].marked, added.json[0].failed], [0, 4]);
  const dead = (await at.command('dead', '--json')).json;
  assert.deepEqual(Object.fromEntries(dead.map(({ input, error }) => [input, error.code])),
    { 'broken.glb': 'bad_file', 'model-0001.glb': 'bad_key', 'model-0002.glb': 'bad_key', 'tiny.ply': 'bad_key' });
  for (const { attempts } of dead) assert.equal(attempts, 1, 'what cannot pass is not tried again');
  assert.deepEqual(marked(at.outRoot), []);

  copyFileSync(keyFile, join(at.keys, 'studio.json'));
  const letter = dead.find(({ input }) => input === 'model-0001.glb').job;
  assert.equal((await at.command('retry', '--json', letter)).json[0].retried, 1);
  await until(() => existsSync(join(at.outRoot, 'model-0001.glb')), 'the one is marked');
  await until(() => reportOf(at, added.json[0]).marked === 1, 'the report says so');
  assert.equal((await at.command('retry', '--json')).json[0].retried, 3);
  await until(() => reportOf(at, added.json[0]).marked === 2, 'the report is written anew');
  const { failed, results } = reportOf(at, added.json[0]);
  assert.equal(failed, 2);
  assert.equal(results.find(({ input }) => input === 'tiny.ply').error.code, 'capacity');
  assert.match((await at.command('dead')).stdout.toString(), /tiny\.ply: .*capacity.*\n/);
  assert.match((await at.command('status')).stdout.toString(), /2 completed, 2 failed/);
});

test('failures that may pass are tried again; a changed input is not marked', needsRedis, async (t) => {
  const at = await start(t, { work: false });
  await writeModels(at.inRoot, 2);
  const request = ['--folder', at.inRoot, '--out', at.outRoot, '--key', at.keyFile, '--id', '1', '--backoff', 300, '--attempts', 8];
  const { run, report } = (await at.command('add', '--json', ...request)).json[0];
  renameSync(join(at.inRoot, 'model-0001.glb'), join(at.root, 'away.glb'));
  writeFileSync(join(at.inRoot, 'model-0002.glb'), glb);
  const worker = await at.startWorker();
  const failuresOf = (name) => worker.lines().filter(({ input, error }) => input === name && error).map(({ error }) => error);
  await until(() => failuresOf('model-0001.glb').length >= 2, 'it failed twice');
  for (const error of failuresOf('model-0001.glb')) assert.match(error, /^io: cannot read/);
  assert.ok(!existsSync(join(at.outRoot, report)), 'the report waits');
  renameSync(join(at.root, 'away.glb'), join(at.inRoot, 'model-0001.glb'));
  const connection = await connect(at.redis.url);
  t.after(() => connection.disconnect());
  await until(async () => (await runStatus(connection, 'quadmark', run)).reported, 'the report is written');
  const [first, second] = reportOf(at, { report }).results;
  assert.equal(first.status, 'marked');
  assert.ok(first.attempts >= 3, `${first.attempts} tries`);
  assert.deepEqual([second.status, second.error.code, second.attempts], ['failed', 'bad_option', 1]);
  assert.match(second.error.message, /changed since it was queued/);
  assert.equal(await retryDead(connection, 'quadmark', ['unknown']), 0);
});

test('a model that takes too long is given up', needsRedis, async (t) => {
  const at = await start(t, { work: false });
  writeFileSync(join(at.inRoot, 'large.glb'), await sculpture('glb', 400_000));
  await writeModels(at.inRoot, 1);
  await at.startWorker({ timeLimit: 1.5 });
  const added = await at.add(['--folder', at.inRoot], '--id', '1');
  assert.equal(added.status, 1);
  const large = reportOf(at, added.json[0]).results.find(({ input }) => input === 'large.glb');
  assert.equal(large.error.code, 'aborted');
  assert.ok(!existsSync(join(at.outRoot, 'large.glb')));
});

test('a run that shares models with another waits for them too', needsRedis, async (t) => {
  const at = await start(t, { work: false });
  await writeModels(at.inRoot, 3);
  const connection = await connect(at.redis.url);
  t.after(() => connection.disconnect());
  const all = [1, 2, 3].map((i) => ({ input: `model-000${i}.glb`, output: `model-000${i}.glb` }));
  const request = { queue: 'quadmark', inRoot: at.inRoot, outRoot: at.outRoot, key: at.key, mark: { id: '1' } };
  const one = await enqueue(connection, { ...request, models: all.slice(0, 2) });
  const two = await enqueue(connection, { ...request, models: all.slice(1) });
  const both = await enqueue(connection, { ...request, models: all });
  assert.deepEqual([one.added, two.added, two.earlier, both.added, both.earlier], [2, 1, 1, 0, 3]);
  const worker = await at.startWorker();
  for (const { run, report, jobs } of [one, two, both]) {
    await until(async () => (await runStatus(connection, 'quadmark', run)).reported, 'the report is written');
    assert.equal(reportOf(at, { report }).marked, jobs);
  }
  assert.equal(worker.lines().length, 3, 'no model is marked twice');
});

test('no key and no model is in Redis', needsRedis, async (t) => {
  const at = await start(t);
  await writeModels(at.inRoot, 1);
  assert.equal((await at.add(['--folder', at.inRoot], '--id', '1')).status, 0);
  const connection = await connect(at.redis.url);
  t.after(() => connection.disconnect());
  const secret = Buffer.from(at.key.secret, 'base64');
  const model = readFileSync(join(at.inRoot, 'model-0001.glb')).subarray(2000, 2032);
  let dumped = 0;
  for (const name of await connection.keys('*')) {
    // Plain values, since a dump may be compressed.
    const type = await connection.type(name);
    const read = { string: () => connection.getBuffer(name), hash: () => connection.hgetallBuffer(name),
      list: () => connection.lrangeBuffer(name, 0, -1), zset: () => connection.zrangeBuffer(name, 0, -1),
      set: () => connection.smembersBuffer(name), stream: () => connection.xrangeBuffer(name, '-', '+') }[type];
    const values = [await read()].flat(Infinity).flatMap((value) => (Buffer.isBuffer(value) ? [value] : Object.values(value)));
    const bytes = Buffer.concat(values.flat(Infinity).filter(Buffer.isBuffer));
    dumped += bytes.length;
    for (const forbidden of [at.key.secret, secret, secret.toString('hex'), model, model.toString('base64').slice(0, 40)]) {
      assert.ok(!bytes.includes(forbidden), name);
    }
  }
  assert.ok(dumped > 1000);
});

test('SIGTERM finishes the model at work', needsRedis, async (t) => {
  const at = await start(t);
  writeFileSync(join(at.inRoot, 'large.glb'), await sculpture('glb', 60_000));
  await writeModels(at.inRoot, 3);
  assert.equal((await at.command('add', '--json', '--folder', at.inRoot, '--out', at.outRoot, '--key', at.keyFile, '--id', '1')).status, 0);
  await until(async () => {
    const { active, completed } = (await at.command('status', '--json')).json[0];
    return active + completed > 0;
  }, 'one is at work');
  assert.equal(await at.worker.stop(), 0);
  const done = at.worker.lines();
  assert.ok(done.length >= 1);
  for (const { output, error } of done) {
    assert.equal(error, undefined);
    assert.equal((await extract(readFileSync(join(at.outRoot, output)), { key: at.key })).verdict, 'match');
  }
  const { active, completed, waiting } = (await at.command('status', '--json')).json[0];
  assert.deepEqual([active, completed + waiting], [0, 4], 'nothing is left in between');
});

test('what cannot be queued is refused with a sentence', needsRedis, async (t) => {
  const at = await start(t, { work: false });
  const folder = temporaryFolder(t);
  writeFileSync(join(at.inRoot, 'a.glb'), glb);
  const list = join(folder, 'list.txt');
  const id = ['--id', '1'];
  const cases = [
    [() => at.add([], ...id), 2, /exactly one of --folder, --bucket and --list/],
    [() => at.add(['--folder', at.inRoot]), 2, /exactly one of id, text and image/],
    [() => at.add(['--folder', at.inRoot], '--id', 'xyz'), 2, /hexadecimal/],
    [() => at.add(['--folder', at.inRoot], '--image', join(at.inRoot, 'a.glb')), 1, /PNG/],
    [() => at.add(['--folder', folder], ...id), 2, /no models/],
    [() => at.add(['--folder', join(folder, 'absent')], ...id), 1, /ENOENT/],
    [() => at.add(['--folder', at.outRoot], ...id), 2, /apart/],
    [() => at.add(['--folder', at.inRoot], ...id, '--report', '../report.json'), 2, /below/],
    [() => at.command('add', '--folder', at.inRoot, '--out', join(at.inRoot, 'marked'), '--key', at.keyFile, ...id), 2, /apart/],
    [() => at.command('add', '--folder', at.inRoot, '--out', at.outRoot, '--key', join(folder, 'absent'), ...id), 1, /ENOENT/],
    [() => at.command('add'), 2, /--out/],
    [() => at.command('status', '--redis', join(folder, 'no.sock')), 1, /cannot be reached/],
    [() => at.command('status', '--redis', 'http://x'), 2, /redis:/],
    [() => at.command('paint'), 2, /unknown command/],
  ];
  for (const [name, status, message] of [['../keys/studio.json', 2, /below/], ['/etc/passwd', 2, /below/], ['absent.glb', 1, /ENOENT/]]) {
    cases.push([() => {
      writeFileSync(list, `${name}\n`);
      return at.add(['--list', list, '--in', at.inRoot], ...id);
    }, status, message]);
  }
  for (const [command, status, message] of cases) {
    const { status: actual, stderr } = await command();
    assert.match(stderr, message);
    assert.equal(actual, status, stderr);
  }
});
