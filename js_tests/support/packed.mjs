// SPDX-License-Identifier: MIT
// The package as npm delivers it: packed, and installed into an empty folder.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { repository, run, temporaryFolder } from './files.mjs';

export const manifest = JSON.parse(readFileSync(join(repository, 'node/package.json'), 'utf8'));

const npm = (args, cwd) => run('npm', [...args, '--no-audit', '--no-fund'], { cwd });

/** { tarball, names } of a package's folder; the tarball goes to `folder`. */
export async function pack(from, folder) {
  const packed = await npm(['pack', '--json', '--pack-destination', folder], from);
  assert.equal(packed.status, 0, packed.stderr);
  const [{ filename, files }] = JSON.parse(packed.stdout);
  return { tarball: join(folder, filename), names: files.map(({ path }) => path) };
}

/**
 * A folder with nothing but package.json and what `npm install quadmark.tgz` puts there.
 * @return { app, names, tarball }  names: the files in the tarball
 */
export async function installedPackage(t) {
  const folder = temporaryFolder(t);
  const { tarball, names } = await pack(join(repository, 'node'), folder);
  const app = join(folder, 'app');
  mkdirSync(app);
  writeFileSync(join(app, 'package.json'), JSON.stringify({ name: 'app', private: true, type: 'module' }));
  // The dependencies come packed from our own node_modules, so that the test needs no network.
  const tarballs = [tarball];
  for (const name of Object.keys(manifest.dependencies)) tarballs.push((await pack(join(repository, 'node_modules', name), folder)).tarball);
  const installed = await npm(['install', '--offline', '--omit=peer', ...tarballs], app);
  assert.equal(installed.status, 0, installed.stderr);
  return { app, names, tarball };
}
