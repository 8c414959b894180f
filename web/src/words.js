// SPDX-License-Identifier: MIT
// Everything the page says about a verdict, a probability or a failure. No DOM here: the words are tested alone.

const count = new Intl.NumberFormat('en-US', { maximumFractionDigits: 0 });
const short = new Intl.NumberFormat('en-US', { maximumSignificantDigits: 3 });

/** A match needs this rare an accident: kMatchProbability of the core. */
const MATCH_ONE_IN = 1e6;

/** x cut down, never up, to `digits` significant digits: "at most 1 in N" must stay true. */
function floorTo(x, digits) {
  const unit = 10 ** (Math.floor(Math.log10(x)) - digits + 1);
  return unit >= 1 ? Math.floor(x / unit) * unit : Math.floor(x);
}

/**
 * A probability as "1 in N".
 * @return { text, exponent }: text "1 in 48,000", "1 in 2.3 billion", or "1 in 10" with the exponent of that ten;
 *         null when it is a half or more, which is no rarity at all
 */
export function oneIn(probability) {
  if (!(probability < 0.5)) return null;
  const n = 1 / probability;
  if (n >= 1e15) return { text: '1 in 10', exponent: Math.floor(Math.log10(n)) };
  for (const [size, word] of [[1e12, 'trillion'], [1e9, 'billion'], [1e6, 'million']]) {
    if (n >= size) return { text: `1 in ${short.format(floorTo(n, 2) / size)} ${word}`, exponent: null };
  }
  return { text: `1 in ${count.format(floorTo(n, 3))}`, exponent: null };
}

/** The same for the ear: "1 in 10 to the power of 23". */
export function oneInSpoken(probability) {
  const odds = oneIn(probability);
  if (!odds) return 'no better than chance';
  return odds.exponent === null ? odds.text : `${odds.text} to the power of ${odds.exponent}`;
}

const LABELS = { match: 'Match', none: 'No mark', inconclusive: 'Inconclusive' };

/** { label, title, meaning } of a result; meaning says what the probability means for it. */
export function verdictWords({ verdict, falsePositive }) {
  const rare = oneIn(falsePositive) !== null;
  const words = {
    match: {
      title: 'This model carries the mark of this key.',
      meaning: 'A model without this mark, or a wrong key, would agree this well by accident at most this often. '
        + `Anything rarer than 1 in ${count.format(MATCH_ONE_IN)} counts as a match.`,
    },
    none: {
      title: 'No mark of this key was found.',
      meaning: rare
        ? 'Agreement like this may come up by accident this often, which is too often to mean anything. Either the model '
          + 'was not marked with this key, or the mark did not survive.'
        : 'What this key reads here agrees no better than accident would. Either the model was not marked with this key, '
          + 'or the mark did not survive.',
    },
    inconclusive: {
      title: 'There are traces of this mark, but too few to be sure.',
      meaning: `Agreement like this may come up by accident this often; a match needs 1 in ${count.format(MATCH_ONE_IN)} or rarer. `
        + 'A more complete copy of the model, or the reference picture, may decide it.',
    },
  };
  return { label: LABELS[verdict], ...words[verdict] };
}

const STAGES = {
  load: 'Loading the detector',
  open: 'Opening the files',
  read: 'Reading the model',
  search: 'Searching the surface for the mark',
  report: 'Drawing the picture',
};

/** What happens now, for a stage of the worker. */
export const stageWords = (stage) => STAGES[stage] ?? 'Working';

/** A message of the API as a sentence: capital letter, full stop. */
export function sentence(message) {
  const text = message.trim();
  const start = /^[a-z]+ /.test(text) ? text[0].toUpperCase() + text.slice(1) : text;
  return /[.!?]$/.test(start) ? start : `${start}.`;
}

const PROBLEMS = {
  model: {
    bad_file: ['cannot be read', 'The file may be damaged, cut short, or of another kind than its name says.'],
    unsupported_file: ['uses something this version cannot read', 'Save it uncompressed from your 3D program and try again.'],
    bad_mesh: ['has no usable surface', 'A mark lives in the vertices of triangles or polygons with finite coordinates.'],
    too_large: ['is too large', 'The command-line tool reads larger models.'],
    io: ['could not be opened', 'Choose the file again.'],
  },
  key: {
    bad_key: ['is not a usable key', 'A key file is the JSON that "quadmark keygen" wrote.'],
    unsupported_version: ['is of a newer version', 'Update this page to a newer version of quadmark.'],
    io: ['could not be opened', 'Choose the file again.'],
  },
  reference: {
    bad_image: ['does not fit', 'The reference is a PNG of the size that the key names. Remove it to check without one.'],
    io: ['could not be opened', 'Choose the file again.'],
  },
  page: {
    too_large: ['ran out of memory', 'The command-line tool can use more memory than a page.'],
    io: ['could not load its detector', 'Reload the page; it must be served by a web server.'],
    internal: ['hit a fault of its own', 'Nothing was decided about the model. Please report what you see here.'],
  },
};

/** { title, text, hint } of a failure; names: file name by "model", "key" and "reference". */
export function problemWords({ about, code, message }, names) {
  const [what, hint] = PROBLEMS[about]?.[code] ?? ['cannot be used', ''];
  const subject = about === 'page' ? 'The page' : names[about];
  return { title: `${subject} ${what}.`, text: sentence(message), hint };
}

/** { title, text, hint } when external buffers of a glTF were not given. */
export function missingWords(uris, modelName) {
  const list = uris.slice(0, 5).join(', ') + (uris.length > 5 ? ` and ${uris.length - 5} more` : '');
  const one = uris.length === 1;
  return {
    title: one ? 'One more file is needed.' : `${uris.length} more files are needed.`,
    text: `${modelName} keeps its geometry in ${list}, which ${one ? 'was' : 'were'} not among the files.`,
    hint: `Drop ${one ? 'that file' : 'those files'} too, or the whole folder. This page never fetches anything by itself.`,
  };
}

/** "1.2 MB" */
export function sizeWords(bytes) {
  if (bytes < 1000) return bytes === 1 ? '1 byte' : `${bytes} bytes`;
  for (const [size, unit] of [[1e9, 'GB'], [1e6, 'MB'], [1e3, 'kB']]) {
    if (bytes >= size) return `${short.format(bytes / size)} ${unit}`;
  }
  return '';
}

/** 0.1234 -> "12.3 %" */
export const percent = (share) => `${short.format(share * 100)} %`;
export const whole = (n) => count.format(n);
