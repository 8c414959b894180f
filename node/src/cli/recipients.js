// SPDX-License-Identifier: MIT
// embed --recipients: from a list to who gets which mark and which folder.
import { dirname, resolve } from 'node:path';
import { QuadmarkError } from '../error.js';
import { decodeImage, keyFingerprint, recipientId } from '../index_node.js';
import { parseRecipients } from '../recipient_list.js';
import { naming, readInput } from './files.js';
import { RegistryFile } from './registry_file.js';

const MAX_FOLDER_BYTES = 200;

/** A folder's name for a recipient's, such as every file system takes it. */
function folderOf(recipient) {
  let name = recipient.replace(/[<>:"/\\|?*]/g, '-').replace(/^\.+/, '').replace(/[. ]+$/, '');
  while (Buffer.byteLength(name) > MAX_FOLDER_BYTES) name = [...name].slice(0, -1).join('');
  return /^(con|prn|aux|nul|com\d|lpt\d|)$/i.test(name) ? `${name}_` : name;
}

function checkFolder(folder, where) {
  if (folder !== folderOf(folder)) throw new QuadmarkError('bad_file', `${where}: ${JSON.stringify(folder)} is not the name of one folder`);
  return folder;
}

async function textOf(path) {
  const bytes = await readInput(path, 'cannot read the list of recipients');
  try {
    return new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(bytes);
  } catch (cause) {
    throw new QuadmarkError('bad_file', `${path}: not UTF-8 text`, { cause });
  }
}

/**
 * Reads a list, gives everybody a mark, and opens the registry.
 * @return { people: [{ recipient, folder, id | image }], registry }
 */
export async function readRecipients(path, { registry: registryPath, salt, dryRun }, key) {
  const list = parseRecipients(await textOf(path), path);
  const folders = new Map(), people = [];
  for (const { recipient, image, folder, line } of list) {
    const where = `${path}, line ${line}`;
    const person = { recipient, folder: folder === undefined ? folderOf(recipient) : checkFolder(folder, where), line };
    const taken = folders.get(person.folder.toLowerCase());
    if (taken !== undefined) {
      throw new QuadmarkError('bad_file', `${where}: the folder ${JSON.stringify(person.folder)} is that of line ${taken} too: give other names in a column folder`);
    }
    folders.set(person.folder.toLowerCase(), line);
    if (image === undefined) person.id = await recipientId(key, recipient);
    else person.image = await naming(`${where}: ${image}`, ['bad_image'], decodeImage(await readInput(resolve(dirname(path), image), `${where}: cannot read`)));
    people.push(person);
  }
  const registry = new RegistryFile(registryPath, await keyFingerprint(key), { dryRun });
  try {
    for (const { recipient, id, image, line } of people) registry.claim({ recipient, id, image, salt }, `${path}, line ${line}`);
  } catch (error) {
    registry.close();
    throw error;
  }
  return { people, registry };
}

/** Refuses options that do not go together. */
export function checkRecipientOptions({ recipients, registry, outDir }) {
  if (recipients !== undefined && (registry === undefined || outDir === undefined)) {
    throw new QuadmarkError('bad_option', '--recipients needs --registry and --out-dir');
  }
  if (recipients === undefined && registry !== undefined) throw new QuadmarkError('bad_option', '--registry goes with --recipients');
}
