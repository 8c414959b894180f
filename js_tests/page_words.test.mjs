// SPDX-License-Identifier: MIT
// What the page says, and how it tells dropped files apart: modules without a document, tested in Node.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ERROR_EXIT_STATUS } from 'quadmark';
import { findPart } from '../web/src/files/paths.js';
import { sortItems, splitStrangers } from '../web/src/files/sort.js';
import { LANGUAGES, scientific, secondsWords, setLanguage, sizeWords, TEXTS } from '../web/src/words/language.js';
import { oneIn, oneInSpoken, verdictWords } from '../web/src/words/odds.js';
import { missingWords, problemWords, sentence } from '../web/src/words/problems.js';

const item = (path, ...content) => ({ path, file: new File(content, path.slice(path.lastIndexOf('/') + 1)) });
const PNG = Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a);

test('a probability is said as "1 in N", never rarer than it is', () => {
  const cases = [
    [1, null], [0.5, null], [NaN, null], [0.49, '1 in 2'], [0.1, '1 in 10'], [1 / 48123, '1 in 48,100'], [1 / 999999, '1 in 999,000'],
    [4.4e-7, '1 in 2.2 million'], [1 / 2.39e9, '1 in 2.3 billion'], [1 / 7.77e13, '1 in 77 trillion'],
  ];
  for (const [probability, text] of cases) {
    assert.equal(oneIn(probability)?.text ?? null, text, String(probability));
  }
  assert.deepEqual(oneIn(1e-16 / 9.9), { text: '1 in 10', exponent: 16 });
  assert.equal(oneInSpoken(9.9e-300), '1 in 10 to the power of 299');
  assert.equal(oneInSpoken(0.7), 'no better than chance');
  const scale = { million: 1e6, billion: 1e9, trillion: 1e12 };
  for (let i = 1; i < 300; ++i) {
    const probability = 0.45 * 0.87 ** i;
    const { text, exponent } = oneIn(probability);
    const [, number, word] = /^1 in ([\d.,]+)(?: (\w+))?$/.exec(text);
    const n = exponent === null ? Number(number.replaceAll(',', '')) * (scale[word] ?? 1) : 10 ** exponent;
    assert.ok(n * probability <= 1 + 1e-12, `${text} for ${probability}`);
    assert.ok(n * probability > (exponent === null ? 0.65 : 0.0999), `${text} for ${probability}`);
  }
});

test('each verdict has its own label, sentence and meaning', () => {
  const all = ['match', 'none', 'inconclusive'].map((verdict) => verdictWords({ verdict, falsePositive: 1e-5 }));
  assert.equal(new Set(all.map(({ title }) => title)).size, 3);
  assert.equal(new Set(all.map(({ label }) => label)).size, 3);
  for (const { meaning } of all) assert.match(meaning, /\.$/);
  assert.match(verdictWords({ verdict: 'none', falsePositive: 1 }).meaning, /no better than accident/);
});

test('every error code has words for the files it may be about', () => {
  const names = { model: 'a.glb', key: 'k.json', reference: 'r.png' };
  for (const code of Object.keys(ERROR_EXIT_STATUS)) {
    for (const about of ['model', 'key', 'reference', 'page']) {
      const { title, text } = problemWords({ about, code, message: 'accessor 3: byteOffset 412 exceeds bufferView 1 (400 bytes)' }, names);
      assert.ok(title.startsWith(about === 'page' ? 'The page ' : names[about]), title);
      assert.equal(text, 'Accessor 3: byteOffset 412 exceeds bufferView 1 (400 bytes).');
    }
  }
  assert.equal(sentence('glTF: the file has no triangles'), 'glTF: the file has no triangles.');
  assert.match(missingWords(['a.bin', 'b.bin'], 's.gltf').text, /a\.bin, b\.bin, which were not/);
  assert.match(missingWords(['1', '2', '3', '4', '5', '6', '7'], 's.gltf').text, /5 and 2 more/);
  assert.deepEqual([0, 1, 999, 1000, 1234567, 2.5e9].map(sizeWords), ['0 bytes', '1 byte', '999 bytes', '1 kB', '1.23 MB', '2.5 GB']);
});

test('files are told apart by content before name', async () => {
  const sorted = await sortItems([
    item('model.txt', 'ply\nformat ascii 1.0\n'), item('key', '{"quadmark": 1}'), item('picture.dat', PNG), item('notes.md', 'hello'),
  ]);
  assert.deepEqual([sorted.models[0].path, sorted.key.path, sorted.reference.path], ['model.txt', 'key', 'picture.dat']);
  assert.deepEqual(sorted.parts.map(({ path }) => path), ['notes.md']);
  assert.deepEqual(sorted.notices, []);
  assert.equal((await sortItems([item('a.gltf', '\ufeff  {"asset": {"version": "2.0"}}')])).models[0].path, 'a.gltf');
  assert.equal((await sortItems([item('a.ply')])).models[0].path, 'a.ply', 'an empty file is what its name says');
  assert.equal((await sortItems([item('k.json', 'oops')])).key.path, 'k.json');
  assert.deepEqual((await sortItems([item('plywood.txt', 'plywood')])).models, []);
  assert.equal((await sortItems([item('a.dat', Uint8Array.of(0x50, 0x4b, 3, 4))])).archives[0].path, 'a.dat');
});

test('models may be many, keys may not', async () => {
  const sorted = await sortItems([item('a.glb', 'glTF'), item('b.ply', 'ply\n'), item('k.json', '{"quadmark": 1}'), item('l.json', '{"quadmark": 1}')]);
  assert.deepEqual(sorted.models.map(({ path }) => path), ['a.glb', 'b.ply']);
  assert.equal(sorted.key, undefined);
  assert.deepEqual(sorted.notices, ['2 key files at once (k.json, l.json): give one at a time.']);
});

test('every text is there in both languages, and fills the same gaps', () => {
  for (const [name, texts] of Object.entries(TEXTS)) {
    assert.equal(texts.length, LANGUAGES.length, name);
    assert.equal(new Set(texts.map((text) => typeof text)).size, 1, name);
    for (const text of texts) if (typeof text === 'string') assert.equal(text, text.trim(), name);
  }
});

test('German words and numbers', (t) => {
  setLanguage('de');
  t.after(() => setLanguage('en'));
  assert.equal(oneIn(1 / 48123).text, '1 zu 48.100');
  assert.equal(oneIn(1 / 2.39e9).text, '1 zu 2,3 Milliarden');
  assert.equal(oneIn(1 / 1.04e6).text, '1 zu 1 Million');
  assert.equal(oneInSpoken(1e-23), '1 zu 10 hoch 23');
  assert.equal(verdictWords({ verdict: 'match', falsePositive: 1e-20 }).label, 'Treffer');
  assert.equal(problemWords({ about: 'model', code: 'bad_file', message: 'cut off' }, { model: 'a.glb' }).title, 'a.glb ist nicht lesbar.');
  assert.deepEqual([1, 1.5e6].map(sizeWords), ['1 Byte', '1,5 MB']);
  assert.equal(secondsWords(1304), '1,30 s');
  assert.deepEqual([0, 0.0125, 5.74e-10].map(scientific), ['0', '0,0125', '5,7 × 10⁻¹⁰']);
});

test('pictures a glTF uses are its textures, and a folder full of them is no reference', async () => {
  const gltf = JSON.stringify({ asset: { version: '2.0' }, images: [{ uri: 'tex/my%20skin.png' }, {}, null] });
  const sorted = await sortItems([item('s.gltf', gltf), item('my skin.png', PNG), item('logo.png', PNG)]);
  assert.equal(sorted.reference.path, 'logo.png');
  const folder = await sortItems([item('d/a.glb', 'glTF'), item('d/1.png', PNG), item('d/2.png', PNG)]);
  assert.equal(folder.reference, undefined);
  assert.deepEqual(folder.notices, []);
});

test('buffers are found beside their glTF, by name when alone', () => {
  const parts = ['s/a.bin', 't/a.bin', 's/buffers/b c.bin', 'd.bin'].map((path) => item(path));
  assert.equal(findPart('a.bin', 's/scene.gltf', parts).path, 's/a.bin');
  assert.equal(findPart('./buffers/b%20c.bin', 's/scene.gltf', parts).path, 's/buffers/b c.bin');
  assert.equal(findPart('https://x.invalid/d.bin', 's/scene.gltf', parts).path, 'd.bin');
  assert.equal(findPart('a.bin', 'scene.gltf', parts), undefined, 'two of that name and neither beside it');
  assert.equal(findPart('%zz.bin', 'scene.gltf', parts), undefined);
});

test('strangers are named unless they may belong to a glTF or came with a folder', () => {
  const items = [item('a.jpg'), item('b.bin'), item('f/c.txt')];
  const loose = splitStrangers(items, []);
  assert.deepEqual(loose.notices.map((text) => text.split(' ')[0]), ['a.jpg']);
  assert.deepEqual(loose.parts.map(({ path }) => path), ['b.bin']);
  assert.deepEqual(splitStrangers(items, [item('s.gltf')]), { parts: items, notices: [] });
});
