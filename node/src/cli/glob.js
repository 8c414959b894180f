// SPDX-License-Identifier: MIT
// Globs, for shells that hand them over unexpanded: *, ?, **, [abc] and {one,two}, matched against names, never following
// symbolic links to directories.
import { existsSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { QuadmarkError } from '../error.js';

const isPattern = (text) => /[*?]|\[[^\]]+\]|\{[^}]*,[^}]*\}/.test(text);

/** "{a,b}c" as ["ac", "bc"]; braces may be nested. */
function withoutBraces(text) {
  const found = /\{([^{}]*,[^{}]*)\}/.exec(text);
  if (!found) return [text];
  const [whole, list] = found;
  return list.split(',').flatMap((word) => withoutBraces(text.slice(0, found.index) + word + text.slice(found.index + whole.length)));
}

function toRegExp(segment) {
  const source = segment.replace(/\[(!|\^)?([^\]]+)\]|[.+^${}()|[\]\\*?]/g, (part, not, set) => {
    if (set !== undefined) return `[${not ? '^' : ''}${set.replace(/[\\^[]/g, '\\$&')}]`;
    return { '*': '.*', '?': '.' }[part] ?? `\\${part}`;
  });
  try {
    return new RegExp(`^${source}$`, 'u');
  } catch (cause) {
    throw new QuadmarkError('bad_option', `${segment}: not a pattern that can be matched`, { cause });
  }
}

function list(directory) {
  try {
    return readdirSync(directory || '.', { withFileTypes: true }).sort((a, b) => (a.name < b.name ? -1 : 1));
  } catch {
    return [];  // not a directory, or not ours to read: nothing matches there
  }
}

function* match(directory, [segment, ...rest]) {
  if (segment === '**') {
    yield* rest.length > 0 ? match(directory, rest) : [];
    for (const entry of list(directory)) {
      if (entry.isDirectory() && !entry.name.startsWith('.')) yield* match(join(directory, entry.name), ['**', ...rest]);
    }
    return;
  }
  if (!isPattern(segment)) {
    const path = directory === '' ? segment || '/' : join(directory, segment);
    if (rest.length > 0) yield* match(path, rest);
    else if (existsSync(path)) yield path;
    return;
  }
  const pattern = toRegExp(segment);
  for (const entry of list(directory)) {
    // As in shells, a wildcard does not match a leading dot.
    if (!pattern.test(entry.name) || (entry.name.startsWith('.') && !segment.startsWith('.'))) continue;
    const path = join(directory, entry.name);
    if (rest.length > 0) yield* match(path, rest);
    else if (!entry.isDirectory()) yield path;
  }
}

/** Names as given, patterns replaced by what they match; fails with `io` when one matches nothing. */
export function expandGlobs(names) {
  return names.flatMap((name) => {
    if (name === '-' || !isPattern(name) || existsSync(name)) return [name];
    const found = [...new Set(withoutBraces(name).flatMap((pattern) => [...match('', pattern.split('/'))]))];
    if (found.length === 0) throw new QuadmarkError('io', `${name}: no file matches`);
    return found;
  });
}
