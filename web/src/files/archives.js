// SPDX-License-Identifier: MIT
// Zip files among what was dropped, opened by a worker of their own.
import { Engine } from '../engine.js';
import { t } from '../words/language.js';
import { sortItems } from './sort.js';

/** @return {{ items: Item[], notices: string[] }}  the items with those of the archives in their places */
export async function openArchives(items) {
  const { archives } = await sortItems(items);
  if (archives.length === 0) return { items, notices: [] };
  const engine = new Engine();
  const notices = [];
  const unpacked = [];
  for (const archive of archives) {
    const answer = await engine.run({ job: 'unpack', archive });
    if (answer.type === 'result') unpacked.push(...answer.items);
    else notices.push(t('archiveFailed', { path: archive.path, why: answer.message }));
    if (answer.items?.length === 0) notices.push(t('archiveEmpty', archive.path));
  }
  engine.end();
  return { items: [...items.filter((item) => !archives.includes(item)), ...unpacked], notices };
}
