// SPDX-License-Identifier: MIT
// The HTTP endpoint: what it answers. Its limits are in server_limits.test.mjs.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { createKey, embed, ERROR_EXIT_STATUS, extract } from 'quadmark';
import { SERVER_CODES, STATUS_OF_CODE } from '../server/src/errors.js';
import { realModel, temporaryFolder } from './support/files.mjs';
import { splitGlb } from './support/gltf.mjs';
import { logo, logoPng, sculpture } from './support/marks.mjs';
import { formOf, keyDirectory, metricOf, startServer } from './support/server.mjs';

const glb = await sculpture('glb', 3000);
const ply = await sculpture('ply', 3000);
const image = logo();
const robust = await createKey({ owner: 'Example Studio' });
const paper = await createKey({ width: 24, height: 24 });

async function start(t) {
  const keys = keyDirectory(temporaryFolder(t), { studio: robust, fine_print: paper, broken: { quadmark: 1 } });
  const server = await startServer(t, keys);
  const post = (path, body, headers = {}) => fetch(`${server.url}/v1/${path}`, { method: 'POST', body, headers });
  const raw = (path, body, headers = {}) =>
    post(path, body, { 'quadmark-key': 'studio', 'content-type': 'application/octet-stream', ...headers });
  const form = (path, fields, headers) => post(path, formOf(fields), headers);
  return { ...server, raw, form };
}

/** Asserts status, code and a sentence of the API's kind. */
async function refused(response, status, code, message) {
  const text = await response.text();
  assert.equal(response.status, status, text);
  const { error } = JSON.parse(text);
  assert.equal(error.code, code, error.message);
  assert.match(error.message, message);
  assert.doesNotMatch(error.message, /\n|\.$/);
  assert.match(response.headers.get('x-request-id'), /^[\w.-]+$/);
}

const bytesOf = async (response) => {
  assert.equal(response.status, 200, response.status === 200 ? '' : await response.text());
  return new Uint8Array(await response.arrayBuffer());
};

test('a raw body is marked with the very bytes of the library, and read', async (t) => {
  const { raw } = await start(t);
  for (const [model, type] of [[glb, 'model/gltf-binary'], [ply, 'model/ply']]) {
    const response = await raw('embed?id=c0ffee&strength=strong', model, { 'content-type': type });
    assert.equal(response.headers.get('content-type'), type);
    const marked = await bytesOf(response);
    const expected = await embed(model, { key: robust, id: 'c0ffee', options: { strength: 'strong' } });
    assert.deepEqual(marked, expected.bytes);
    const read = await (await raw('extract', marked)).json();
    const own = (await extract(marked, { key: robust })).report;
    const { command, millis, ...report } = read;
    assert.equal(command, 'extract');
    assert.ok(millis > 0);
    assert.deepEqual(report, JSON.parse(JSON.stringify(own)), 'the JSON of the command line');
    assert.equal(read.verdict, 'match');
    assert.equal((await (await raw('extract', model)).json()).verdict, 'none', 'no mark is a result');
  }
});

test('a form is marked with a picture, text or ID and read with its reference', async (t) => {
  const { form } = await start(t);
  const marked = await bytesOf(await form('embed', { key: 'fine_print', model: glb, image: logoPng(image) }));
  assert.deepEqual(marked, (await embed(glb, { key: paper, image })).bytes);
  const read = await (await form('extract', { key: 'fine_print', model: marked, reference: logoPng(image) })).json();
  assert.equal(read.verdict, 'match');
  assert.equal(read.ber, 0);

  // In any order, the key in the header, options as fields.
  const named = await bytesOf(await form('embed', { text: 'Ünï', selfTest: 'true', model: glb }, { 'quadmark-key': 'studio' }));
  assert.deepEqual(named, (await embed(glb, { key: robust, text: 'Ünï', options: { selfTest: true } })).bytes);
  assert.equal((await (await form('extract', { model: named, key: 'studio', expectText: 'Ünï' })).json()).text, 'Ünï');
});

test('the report comes with the model in JSON or in a form', async (t) => {
  const { raw } = await start(t);
  const expected = await embed(glb, { key: robust, id: '1' });
  const json = await (await raw('embed?id=1', glb, { accept: 'application/json' })).json();
  const { command, model, resources, millis, ...report } = json;
  assert.equal(command, 'embed');
  assert.ok(millis > 0);
  assert.deepEqual(resources, {});
  assert.deepEqual(new Uint8Array(Buffer.from(model, 'base64')), expected.bytes);
  assert.deepEqual(report, JSON.parse(JSON.stringify(expected.report)));

  const form = await (await raw('embed?id=1', glb, { accept: 'multipart/form-data' })).formData();
  assert.deepEqual(new Uint8Array(await form.get('model').arrayBuffer()), expected.bytes);
  assert.equal(JSON.parse(await form.get('report')).scheme, 'robust');
  await refused(await raw('embed?id=1', glb, { accept: 'text/html' }), 406, 'bad_option', /Accept/);
});

test('a glTF comes with its buffers and goes back with those that changed', async (t) => {
  const { form, raw } = await start(t);
  const { gltf, bin } = splitGlb(glb, 'a folder/mesh 1.bin');
  const resource = [{ bytes: bin, filename: 'a folder/mesh 1.bin' }, { bytes: Buffer.from('unused'), filename: 'other.bin' }];
  const expected = await embed(gltf, { key: robust, id: '1', resources: { 'a folder/mesh 1.bin': bin } });
  const fields = { key: 'studio', id: '1', model: gltf, resource };
  const json = await (await form('embed', fields, { accept: 'application/json' })).json();
  assert.deepEqual(new Uint8Array(Buffer.from(json.model, 'base64')), expected.bytes);
  const changed = Object.entries(json.resources);
  assert.deepEqual(changed.map(([uri]) => uri), Object.keys(expected.resources));
  assert.deepEqual(new Uint8Array(Buffer.from(changed[0][1], 'base64')), Object.values(expected.resources)[0]);
  const parts = await (await form('embed', fields, { accept: 'multipart/form-data' })).formData();
  assert.equal(parts.get('resource').name, 'a folder/mesh 1.bin');
  assert.deepEqual(new Uint8Array(await parts.get('resource').arrayBuffer()), Object.values(expected.resources)[0]);
  await refused(await form('embed', fields), 406, 'bad_option', /external buffers/);
  // A URI in a file is never followed.
  await refused(await raw('embed?id=1', gltf), 422, 'bad_file', /mesh/);
  for (const uri of ['/etc/passwd', 'file:///etc/passwd', 'http://127.0.0.1:1/mesh.bin']) {
    const away = JSON.parse(gltf);
    away.buffers[0].uri = uri;
    await refused(await raw('embed?id=1', Buffer.from(JSON.stringify(away))), 422, 'bad_file', /was not given/);
  }
});

test('real models are marked and read, Draco compression included', async (t) => {
  const { raw } = await start(t);
  for (const name of ['fandisk.glb', 'Duck.glb', 'CesiumMan.glb']) {
    const path = realModel(t, name);
    if (!path) continue;
    const marked = await bytesOf(await raw('embed?id=feed', readFileSync(path)));
    assert.equal((await (await raw('extract', marked)).json()).id, '000000000000feed', name);
  }
  const draco = realModel(t, 'bunny_gltf.drc');
  if (draco) assert.equal((await (await raw('extract', readFileSync(draco))).json()).verdict, 'none');
});

test('every failure has the status of its code', async (t) => {
  assert.deepEqual(Object.keys(STATUS_OF_CODE), Object.keys(ERROR_EXIT_STATUS));
  for (const code of Object.keys(SERVER_CODES)) assert.ok(!(code in STATUS_OF_CODE));
  const { raw, form, url } = await start(t);
  const tiny = await sculpture('ply', 60);
  const cases = [
    [() => raw('extract', Buffer.from('Kaydara FBX')), 422, 'bad_file', /./],
    [() => raw('extract', Buffer.alloc(0)), 422, 'bad_file', /./],
    [() => raw('embed?id=1', glb.subarray(0, 2000)), 422, 'bad_file', /./],
    [() => raw('embed?id=1', tiny), 422, 'capacity', /./],
    [() => raw('embed', glb), 400, 'bad_option', /exactly one of image, id and text/],
    [() => raw('embed?id=1&text=a', glb), 400, 'bad_option', /exactly one/],
    [() => raw('embed?id=xyz', glb), 400, 'bad_option', /id: expected/],
    [() => raw('embed?id=1&maxError=big', glb), 400, 'bad_option', /maxError: must be number/],
    [() => raw('embed?id=1&strength=huge', glb), 400, 'bad_option', /strength: .*standard/],
    [() => raw('embed?id=1&key=studio', glb), 400, 'bad_option', /unknown option "key"/],
    [() => raw('embed?id=1&id=2', glb), 400, 'bad_option', /id/],
    [() => raw('embed?id=1', glb, { 'quadmark-key': 'fine_print' }), 422, 'bad_key', /./],
    [() => raw('embed?id=1', glb, { 'quadmark-key': 'broken' }), 422, 'bad_key', /./],
    [() => raw('embed?id=1', glb, { 'content-type': 'text/html' }), 415, 'unsupported_file', /media type/],
    [() => raw('embed?id=1', glb, { origin: 'http://evil.example' }), 403, 'forbidden', /pages/],
    [() => form('embed', { key: 'studio', id: '1' }), 400, 'bad_option', /model is missing/],
    [() => form('embed', { key: 'studio', model: [glb, glb], id: '1' }), 400, 'bad_option', /model is given twice/],
    [() => form('embed', { key: ['studio', 'studio'], model: glb, id: '1' }), 400, 'bad_option', /key is given twice/],
    [() => form('embed', { key: 'studio', model: glb, colour: 'red' }), 400, 'bad_option', /unknown option "colour"/],
    [() => form('embed', { key: 'studio', model: glb, photo: glb }), 400, 'bad_option', /unexpected file "photo"/],
    [() => form('embed', { key: 'studio', model: glb, text: 'a'.repeat(5000) }), 400, 'bad_option', /longer than 4096/],
    [() => form('embed', { key: 'studio', model: glb, image: Buffer.from('GIF89a') }), 422, 'bad_image', /PNG/],
    [() => form('embed?id=1', { key: 'studio', model: glb }), 400, 'bad_option', /not in the URL/],
    [() => form('extract', { key: 'studio', model: glb }, { 'quadmark-key': 'studio' }), 400, 'bad_option', /twice/],
    [() => raw('embed?id=1', 'no boundary', { 'content-type': 'multipart/form-data' }), 400, 'bad_option', /./],
    [() => raw('embed?id=1', '--b\r\nContent-Disposition: form-data; name="model"; filename="a"\r\n\r\ncut', { 'content-type': 'multipart/form-data; boundary=b' }), 400, 'bad_option', /./],
    [() => fetch(`${url}/v1/paint`, { method: 'POST' }), 404, 'not_found', /openapi/],
    [() => fetch(`${url}/v1/embed`), 404, 'not_found', /./],
  ];
  for (const [ask, ...expected] of cases) await refused(await ask(), ...expected);
  assert.equal(await metricOf(url, 'quadmark_requests_inside'), 0);
});

test('the document describes the routes by the schemas that validate', async (t) => {
  const { url } = await start(t);
  const { openapi, paths } = await (await fetch(`${url}/openapi.json`)).json();
  assert.match(openapi, /^3\.1/);
  assert.deepEqual(Object.keys(paths).sort(), ['/healthz', '/metrics', '/openapi.json', '/readyz', '/v1/embed', '/v1/extract']);
  const { parameters, requestBody, responses } = paths['/v1/embed'].post;
  assert.deepEqual(parameters.filter((item) => item.in === 'query').map(({ name }) => name),
    ['id', 'text', 'strength', 'maxError', 'maxSlide', 'salt', 'selfTest']);
  assert.deepEqual(parameters.filter((item) => item.in === 'header').map(({ name }) => name), ['quadmark-key']);
  assert.ok(requestBody.content['multipart/form-data'].schema.properties.image);
  for (const status of ['200', '400', '403', '404', '406', '408', '413', '415', '422', '500', '503']) assert.ok(responses[status], status);
  for (const path of ['/healthz', '/readyz', '/metrics']) assert.equal((await fetch(url + path)).status, 200);
});

test('logs are JSON lines without keys, payloads or model data, and request ids run through', async (t) => {
  const { raw, form, url, logs, stop } = await start(t);
  await raw('embed?id=deadbeefdeadbeef', glb, { 'x-request-id': 'build-7.3' });
  const echoed = await raw('extract', glb, { 'x-request-id': 'build-7.4' });
  assert.equal(echoed.headers.get('x-request-id'), 'build-7.4');
  await form('embed', { key: 'studio', model: glb, text: 'payload text' }, { 'x-request-id': 'no\tgood one' });
  await form('embed', { key: 'studio', model: glb.subarray(0, 500), id: '7' });
  await raw('embed?id=1', glb, { 'quadmark-key': robust.secret });
  await raw('extract', splitGlb(glb, 'file-name-inside.bin').gltf);
  await fetch(`${url}/v1/${encodeURIComponent(robust.secret)}`);
  assert.equal(await stop(), 0);
  const lines = logs().trim().split('\n').map((line) => JSON.parse(line));
  assert.ok(lines.some(({ reqId, route, status }) => reqId === 'build-7.3' && route === '/v1/embed' && status === 200));
  assert.equal(lines.filter(({ msg }) => msg === 'answered').length, 7);
  const text = logs();
  const secret = Buffer.from(robust.secret, 'base64');
  const body = Buffer.from(glb.buffer, glb.byteOffset, glb.byteLength);
  for (const [what, forbidden] of Object.entries({
    'the secret': robust.secret, 'the secret in hex': secret.toString('hex'), 'an encoded secret': encodeURIComponent(robust.secret),
    'the key id': 'studio', 'an ID': 'deadbeef', 'a text': 'payload text', 'a name in the file': 'file-name-inside',
    'the beginning of the model': body.subarray(0, 48).toString('base64'), 'its middle': body.subarray(3000, 3048).toString('base64'),
    'its text': 'sculpture', 'the owner': 'Example Studio',
  })) {
    assert.ok(!text.includes(forbidden), `${what} is in the logs`);
  }
});
