// SPDX-License-Identifier: MIT
// Load on the HTTP endpoint: many mixed requests at once, one in twenty hostile, and the answer that each must get.
import assert from 'node:assert/strict';
import autocannon from 'autocannon';
import { embed } from 'quadmark';
import { openGltf } from './gltf.mjs';
import { logo, logoPng, sculpture } from './marks.mjs';
import { writePng } from './png.mjs';
import { randomNumbers } from './random.mjs';
import { metricOf } from './server.mjs';

const MEBI = 2 ** 20;

/** A multipart body: [{ name, filename?, content }] -> { body, headers }. */
function multipart(parts) {
  const boundary = 'quadmark-load-boundary';
  const chunks = parts.flatMap(({ name, filename, content }) => [
    Buffer.from(`--${boundary}\r\nContent-Disposition: form-data; name="${name}"${filename ? `; filename="${filename}"` : ''}\r\n\r\n`),
    Buffer.from(content), Buffer.from('\r\n')]);
  return { body: Buffer.concat([...chunks, Buffer.from(`--${boundary}--\r\n`)]), headers: { 'content-type': `multipart/form-data; boundary=${boundary}` } };
}

/**
 * Kinds of requests: { honest, hostile }, each [{ name, status, code or verdict, request of autocannon }].
 * @param key           of scheme robust, on the server under the id `studio`
 * @param bodyLimitMiB  of the server
 */
export async function requestKinds(key, bodyLimitMiB) {
  const glb = await sculpture('glb', 3000);
  const ply = await sculpture('ply', 3000);
  const detailed = await sculpture('glb', 12_000);
  const marked = (await embed(glb, { key, id: 'c0ffee' })).bytes;
  const raw = (name, status, path, body, expected = {}, headers = {}) => ({ name, status, ...expected, request: {
    method: 'POST', path: `/v1/${path}`, body: Buffer.from(body),
    headers: { 'quadmark-key': 'studio', 'content-type': 'application/octet-stream', ...headers },
  } });
  const form = (name, status, path, parts, expected = {}) => {
    const { body, headers } = multipart(parts);
    return { name, status, ...expected, request: { method: 'POST', path: `/v1/${path}`, body, headers } };
  };
  const field = (name, content) => ({ name, content });
  const file = (name, content) => ({ name, filename: name, content });

  const { json, bin } = openGltf(glb);
  json.buffers[0] = { uri: 'file:///etc/passwd', byteLength: bin.length };
  const lying = 'ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n';
  const png = writePng(2, 2, [0, 0, 0, 0], { width: 60000, height: 60000 });
  return {
    honest: [
      raw('embed GLB', 200, 'embed?id=c0ffee', glb),
      raw('embed PLY', 200, 'embed?text=load', ply),
      raw('embed, answer in JSON', 200, 'embed?id=1&strength=strong', glb, {}, { accept: 'application/json' }),
      form('embed a picture', 200, 'embed', [field('key', 'studio'), file('image', logoPng(logo(12))), file('model', detailed)]),
      raw('extract, marked', 200, 'extract', marked, { verdict: 'match' }),
      raw('extract, unmarked', 200, 'extract', glb, { verdict: 'none' }),
      form('extract, expected', 200, 'extract', [file('model', marked), field('key', 'studio'), field('expectId', 'c0ffee')], { verdict: 'match' }),
    ],
    hostile: [
      raw('noise', 422, 'extract', Buffer.from(Array.from({ length: 5000 }, (_, i) => (i * 7919) % 251)), { code: 'bad_file' }),
      raw('a truncated GLB', 422, 'embed?id=1', glb.subarray(0, glb.length >> 1), { code: 'bad_file' }),
      raw('counts that lie', 422, 'extract', lying, { code: 'bad_file' }),
      raw('a URI that leads away', 422, 'embed?id=1', JSON.stringify(json), { code: 'bad_file' }),
      raw('deep JSON', 422, 'extract', `{"asset":${'['.repeat(200_000)}`, { code: 'bad_file' }),
      raw('another media type', 415, 'embed?id=1', glb, { code: 'unsupported_file' }, { 'content-type': 'text/html' }),
      raw('an unknown key', 404, 'extract', glb, { code: 'bad_key' }, { 'quadmark-key': 'nobody' }),
      raw('a key id that climbs', 400, 'extract', glb, { code: 'bad_key' }, { 'quadmark-key': '../../etc/passwd' }),
      raw('too large', 413, 'extract', Buffer.alloc(bodyLimitMiB * MEBI + 1), { code: 'too_large' }),
      form('a picture that claims 60000 x 60000', 413, 'embed', [field('key', 'studio'), file('image', png), file('model', glb)], { code: 'too_large' }),
      raw('a form without an end', 400, 'embed', '--b\r\nContent-Disposition: form-data; name="model"; filename="a"\r\n\r\ncut', { code: 'bad_option' }, { 'content-type': 'multipart/form-data; boundary=b' }),
    ],
  };
}

/** The order of the requests: one in twenty hostile, evenly mixed, the same for the same seed. */
function mix({ honest, hostile }, count, seed) {
  const random = randomNumbers(seed);
  const order = Array.from({ length: count }, (_, i) => (i % 20 === 0 ? hostile[(i / 20) % hostile.length] : honest[i % honest.length]));
  for (let i = order.length - 1; i > 0; --i) {
    const j = Math.floor(random() * (i + 1));
    [order[i], order[j]] = [order[j], order[i]];
  }
  return order;
}

/**
 * Sends `count` requests over `connections` connections at once and checks every answer.
 * @return { seconds, perSecond, p50, p99, max (milliseconds), hostile, peakBytes, byKind: Map name -> count }
 */
export async function loadRun(url, kinds, { count, connections, seed = 1 }) {
  const order = mix(kinds, count, seed);
  const byKind = new Map();
  const wrong = [];
  const checked = (kind) => ({
    ...kind.request,
    onResponse: (status, body) => {
      byKind.set(kind.name, (byKind.get(kind.name) ?? 0) + 1);
      if (status !== kind.status) wrong.push(`${kind.name}: status ${status}, ${body.slice(0, 200)}`);
      else if (kind.code && JSON.parse(body).error.code !== kind.code) wrong.push(`${kind.name}: ${body.slice(0, 200)}`);
      else if (kind.verdict && JSON.parse(body).verdict !== kind.verdict) wrong.push(`${kind.name}: ${body.slice(0, 200)}`);
    },
  });
  let next = 0;
  const share = (client) => Math.floor(count / connections) + (client < count % connections ? 1 : 0);
  let client = 0;
  let peakBytes = 0;
  const watch = setInterval(async () => {
    peakBytes = Math.max(peakBytes, (await metricOf(url, 'process_resident_memory_bytes').catch(() => 0)) ?? 0);
  }, 250);
  const start = performance.now();
  let result;
  try {
    result = await autocannon({
      url, amount: count, connections, timeout: 120,
      setupClient: (made) => {
        const length = share(client++);
        made.setRequests(order.slice(next, next + length).map(checked));
        next += length;
      },
    });
  } finally {
    clearInterval(watch);
  }
  const seconds = (performance.now() - start) / 1000;
  assert.deepEqual(wrong, []);
  assert.equal([...byKind.values()].reduce((sum, value) => sum + value, 0), count, 'every request was answered');
  assert.deepEqual([result.errors, result.timeouts, result.resets], [0, 0, 0]);
  const hostile = kinds.hostile.reduce((sum, { name }) => sum + (byKind.get(name) ?? 0), 0);
  const { p50, p99, max } = result.latency;
  return { seconds, perSecond: count / seconds, p50, p99, max, hostile, peakBytes, byKind };
}
