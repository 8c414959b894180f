// SPDX-License-Identifier: MIT
// The HTTP endpoint under load: the table in docs/server.md.
//
//   node bench/server.mjs [--requests N] [--connections N] [--write]     --write replaces the table in docs/server.md
//
// Every answer is checked; a wrong one ends the bench. The client runs on the same machine and takes its share of it.
import { mkdtempSync, rmSync } from 'node:fs';
import { availableParallelism, cpus, tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { parseArgs } from 'node:util';
import { createKey, version } from 'quadmark';
import { repository } from '../js_tests/support/files.mjs';
import { loadRun, requestKinds } from '../js_tests/support/load.mjs';
import { keyDirectory, metricOf, startServer } from '../js_tests/support/server.mjs';
import { replaceTable, tableOf } from './support/table.mjs';

const { values: options } = parseArgs({ options: {
  requests: { type: 'string', default: '1000' }, connections: { type: 'string', default: '32' }, write: { type: 'boolean' },
} });
const count = Number(options.requests), connections = Number(options.connections);
const BODY_LIMIT_MIB = 2;
const ROUNDS = 3;
const mebi = (bytes) => Math.round(bytes / 2 ** 20);

const folder = mkdtempSync(join(tmpdir(), 'quadmark-load-'));
const key = await createKey();
const threads = availableParallelism();
const server = await startServer(null, keyDirectory(folder, { studio: key }), { threads, queue: 2 * connections, bodyLimitMiB: BODY_LIMIT_MIB });
try {
  const kinds = await requestKinds(key, BODY_LIMIT_MIB);
  const resident = () => metricOf(server.url, 'process_resident_memory_bytes');
  await loadRun(server.url, kinds, { count: Math.max(connections, count / 4), connections, seed: 100 });
  const warm = await resident();
  const rows = [];
  for (let round = 1; round <= ROUNDS; ++round) {
    const { perSecond, p50, p99, max, hostile, peakBytes } = await loadRun(server.url, kinds, { count, connections, seed: round });
    await sleep(2000);
    rows.push([round, count, hostile, 'all', perSecond.toFixed(1), p50, p99, max, mebi(peakBytes), mebi(await resident())]);
    console.error(rows.at(-1).join('  '));
  }
  const ended = await metricOf(server.url, 'quadmark_threads_ended');
  const table = tableOf(['round', 'requests', 'hostile', 'answered as they must be', 'requests / s', 'p50 ms', 'p99 ms', 'longest ms', 'MiB resident at most', 'MiB resident after'], rows);
  const status = await server.stop();
  const text = `quadmark ${await version()}, ${cpus()[0].model}, ${threads} processors and as many threads, ${connections} connections, `
    + `Node ${process.versions.node}, ${new Date().toISOString().slice(0, 10)}. After a first round of ${Math.max(connections, count / 4)}: ${mebi(warm)} MiB resident. `
    + `Threads lost: ${ended}. Exit status on SIGTERM: ${status}.\n\n${table}`;
  console.log(text);
  if (options.write) replaceTable(join(repository, 'docs/server.md'), 'load', text);
} finally {
  await server.stop();
  rmSync(folder, { recursive: true, force: true });
}
