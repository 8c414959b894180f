// SPDX-License-Identifier: MIT
// The HTTP endpoint as its users run it: `quadmark serve` as a process of its own, with a folder of keys.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { cliFile } from './files.mjs';

/** Writes `keys` ({ id: key }) as a key directory below `folder`; its path. */
export function keyDirectory(folder, keys) {
  const directory = join(folder, 'keys');
  mkdirSync(directory, { recursive: true });
  for (const [id, key] of Object.entries(keys)) writeFileSync(join(directory, `${id}.json`), JSON.stringify(key), { mode: 0o600 });
  return directory;
}

/**
 * Starts `quadmark serve` on a free port.
 * @param t        the test that it ends with; null leaves ending it to the caller
 * @param options  { threads, queue, bodyLimitMiB, timeLimit }
 * @return { url, process, logs(), exit: promise of the exit status, stop() }
 */
export async function startServer(t, keys, { threads = 2, queue = 8, bodyLimitMiB = 8, timeLimit = 60 } = {}) {
  const args = ['serve', '--json', '--port', '0', '--keys', keys, '--threads', threads, '--queue', queue,
    '--body-limit', bodyLimitMiB, '--time-limit', timeLimit].map(String);
  const child = spawn(process.execPath, [cliFile, ...args], { stdio: ['ignore', 'pipe', 'pipe'] });
  let logs = '';
  child.stderr.on('data', (chunk) => { logs += chunk; });
  const exit = once(child, 'exit').then(([status, signal]) => status ?? signal);
  const stop = async () => {
    child.kill('SIGTERM');
    return exit;
  };
  t?.after(stop);
  const [line] = await Promise.race([once(child.stdout, 'data'), exit.then(() => { throw new Error(`the server ended: ${logs}`); })]);
  const { url } = JSON.parse(String(line));
  return { url, process: child, logs: () => logs, exit, stop };
}

/** A multipart body of { name: text, or bytes, or { bytes, filename } }; arrays are repeated fields. */
export function formOf(fields) {
  const form = new FormData();
  for (const [name, values] of Object.entries(fields)) {
    for (const value of Array.isArray(values) ? values : [values]) {
      if (typeof value === 'string') form.append(name, value);
      else form.append(name, new Blob([value.bytes ?? value]), value.filename ?? name);
    }
  }
  return form;
}

/** The value of one series of /metrics, for example `quadmark_threads_ended`. */
export async function metricOf(url, name) {
  const text = await (await fetch(`${url}/metrics`)).text();
  const line = text.split('\n').find((item) => item.startsWith(`${name} `) || item.startsWith(`${name}{`));
  return line === undefined ? undefined : Number(line.slice(line.lastIndexOf(' ') + 1));
}

/** Waits until `condition` holds; throws after a time that is far from any expected one. */
export async function until(condition, what, seconds = 60) {
  const end = Date.now() + seconds * 1000;
  while (!(await condition())) {
    if (Date.now() > end) throw new Error(`still not after ${seconds} s: ${what}`);
    await new Promise((resolve) => { setTimeout(resolve, 20); });
  }
}
