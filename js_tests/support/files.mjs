// SPDX-License-Identifier: MIT
// Temporary folders, real models, and the command line as a user runs it.
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { externalUris } from 'quadmark';

export const repository = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
export const cliFile = join(repository, 'node/src/cli/main.js');

/** A fresh folder that goes when the test `t` ends. */
export function temporaryFolder(t) {
  const folder = mkdtempSync(join(tmpdir(), 'quadmark-'));
  t.after(() => rmSync(folder, { recursive: true, force: true, maxRetries: 10, retryDelay: 50 }));
  return folder;
}

const modelsFolder = resolve(process.env.QUADMARK_MODELS ?? join(repository, '../shared/models'));

/** Path of a real model, or null after saying that it is not there. */
export function realModel(t, name) {
  const path = join(modelsFolder, name);
  if (existsSync(path)) return path;
  t.diagnostic(`real model ${name} is not in ${modelsFolder} (set QUADMARK_MODELS): this part was not tested`);
  return null;
}

/** The names of `names` that are there, as [{ name, path }]. */
export function realModels(t, names) {
  return names.map((name) => ({ name, path: realModel(t, name) })).filter(({ path }) => path !== null);
}

/** All real models of the formats that this version knows, as names; none, after saying so, when there are none. */
export function allRealModels(t) {
  const names = existsSync(modelsFolder)
    ? readdirSync(modelsFolder, { recursive: true }).filter((name) => /\.(glb|gltf|ply|drc)$/.test(name)).sort()
    : [];
  if (names.length === 0) t.diagnostic(`real models are not in ${modelsFolder} (set QUADMARK_MODELS): this part was not tested`);
  return names.map((name) => ({ name, path: join(modelsFolder, name) }));
}

/** { model, resources } of a model on disk, with the buffers it refers to. */
export async function readModelFiles(path) {
  const model = readFileSync(path);
  const read = (uri) => readFileSync(join(dirname(path), decodeURIComponent(uri)));
  return { model, resources: Object.fromEntries((await externalUris(model)).map((uri) => [uri, read(uri)])) };
}

/** { uri: bytes } of the pictures that a .gltf on disk refers to; none for other formats. */
export function readImageFiles(path) {
  if (!path.endsWith('.gltf')) return {};
  const { images = [] } = JSON.parse(readFileSync(path, 'utf8'));
  const uris = images.map(({ uri }) => uri).filter((uri) => uri !== undefined && !uri.startsWith('data:'));
  return Object.fromEntries(uris.map((uri) => [uri, readFileSync(join(dirname(path), decodeURIComponent(uri)))]));
}

/** Runs a program to its end: { status (null: killed, as after `timeout` ms), stdout (Buffer), stderr (text), json (parsed lines of stdout) }. */
export function run(program, args, { input, cwd, env, timeout } = {}) {
  return new Promise((resolveRun, reject) => {
    const child = spawn(program, args, { cwd, timeout, env: { ...process.env, QUADMARK_KEY_FILE: '', ...env } });
    const out = [];
    let stderr = '';
    child.stdout.on('data', (chunk) => out.push(chunk));
    child.stderr.on('data', (chunk) => { stderr += chunk; });
    child.stdin.on('error', () => {});  // a program that fails early does not read its input
    child.on('error', reject);
    child.on('close', (status) => {
      const stdout = Buffer.concat(out);
      resolveRun({
        status,
        stdout,
        stderr,
        get json() { return stdout.toString().trim().split('\n').map((line) => JSON.parse(line)); },
      });
    });
    child.stdin.end(input);
  });
}

export const quadmark = (args, options) => run(process.execPath, [cliFile, ...args], options);
