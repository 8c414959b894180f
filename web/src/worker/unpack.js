// SPDX-License-Identifier: MIT
// Zip files, unpacked in memory.
import { unzipSync } from 'fflate';
import { Problem, readFile } from './files.js';

const MAX_FILES = 2000;
const MAX_BYTES = 2 ** 31;

/** { archive: Item } -> { items }: paths begin with the archive's own, as a folder of that name would. */
export async function unpack({ archive }) {
  const bytes = await readFile('model', archive.file);
  const folder = archive.path.replace(/\.zip$/i, '');
  let total = 0, count = 0;
  const useful = ({ name, originalSize }) => {
    if (name.endsWith('/') || /(^|\/)(__MACOSX|\.DS_Store)/.test(name)) return false;
    total += originalSize;
    if (++count > MAX_FILES) throw new Problem('model', 'too_large', `it holds more than ${MAX_FILES} files`);
    if (total > MAX_BYTES) throw new Problem('model', 'too_large', 'its files have more than 2 GiB together');
    return true;
  };
  let files;
  try {
    files = unzipSync(bytes, { filter: useful });
  } catch (error) {
    throw error instanceof Problem ? error : new Problem('model', 'bad_file', `it is no zip file that can be read (${error.message})`);
  }
  const items = Object.entries(files).map(([name, content]) => ({
    path: `${folder}/${name}`, file: new File([content], name.slice(name.lastIndexOf('/') + 1)),
  }));
  return { answer: { type: 'result', items } };
}
