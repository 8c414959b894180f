// SPDX-License-Identifier: MIT
// What can go wrong: problem_<what it is about>_<error code> ends a sentence that begins with the file's name.

const openFailed = ['could not be opened', 'konnte nicht geöffnet werden'];
const chooseAgain = ['Choose the file again.', 'Wählen Sie die Datei noch einmal.'];

export const PROBLEM_TEXTS = {
  thePage: ['The page', 'Die Seite'],
  problem_other: ['cannot be used', 'ist nicht brauchbar'],
  problem_model_bad_file: ['cannot be read', 'ist nicht lesbar'],
  hint_model_bad_file: ['The file may be damaged, cut short, or of another kind than its name says.', 'Die Datei ist vielleicht beschädigt, abgeschnitten oder von anderer Art, als ihr Name sagt.'],
  problem_model_unsupported_file: ['uses something this version cannot read', 'benutzt etwas, das diese Version nicht lesen kann'],
  hint_model_unsupported_file: ['Save it uncompressed from your 3D program and try again.', 'Speichern Sie es unkomprimiert aus Ihrem 3D-Programm und versuchen Sie es noch einmal.'],
  problem_model_bad_mesh: ['has no usable surface', 'hat keine brauchbare Oberfläche'],
  hint_model_bad_mesh: ['A mark lives in the vertices of triangles or polygons with finite coordinates.', 'Eine Markierung lebt in den Ecken von Dreiecken oder Vielecken mit endlichen Koordinaten.'],
  problem_model_too_large: ['is too large', 'ist zu groß'],
  hint_model_too_large: ['The command-line tool reads larger models.', 'Das Kommandozeilenprogramm liest größere Modelle.'],
  problem_model_io: openFailed,
  hint_model_io: chooseAgain,
  problem_model_capacity: ['has too little room for this mark', 'hat zu wenig Platz für diese Markierung'],
  hint_model_capacity: ['A smaller picture, or an ID instead, needs less room.', 'Ein kleineres Bild oder stattdessen eine ID braucht weniger Platz.'],
  problem_key_bad_key: ['is not a usable key', 'ist kein brauchbarer Schlüssel'],
  hint_key_bad_key: ['A key file is the JSON that "quadmark keygen" or the Mark tab wrote.', 'Eine Schlüsseldatei ist das JSON, das „quadmark keygen“ oder die Seite „Markieren“ geschrieben hat.'],
  problem_key_unsupported_version: ['is of a newer version', 'ist von einer neueren Version'],
  hint_key_unsupported_version: ['Update this page to a newer version of quadmark.', 'Holen Sie eine neuere Version dieser Seite.'],
  problem_key_io: openFailed,
  hint_key_io: chooseAgain,
  problem_reference_bad_image: ['does not fit', 'passt nicht'],
  hint_reference_bad_image: ['The reference is a PNG of the size that the key names. Remove it to check without one.', 'Das Vergleichsbild ist ein PNG in der Größe, die der Schlüssel nennt. Entfernen Sie es, um ohne zu prüfen.'],
  problem_reference_too_large: ['is too large', 'ist zu groß'],
  hint_reference_too_large: ['Hidden pictures are small, at most 128 × 128 pixels: give the reference in that size.', 'Verborgene Bilder sind klein, höchstens 128 × 128 Pixel: Geben Sie das Vergleichsbild in dieser Größe.'],
  problem_reference_io: openFailed,
  hint_reference_io: chooseAgain,
  problem_logo_bad_image: ['cannot be embedded', 'kann nicht eingebettet werden'],
  hint_logo_bad_image: ['Give a picture with dark and light parts, up to 128 × 128 pixels after fitting.', 'Geben Sie ein Bild mit dunklen und hellen Teilen, nach dem Einpassen höchstens 128 × 128 Pixel.'],
  problem_logo_bad_option: ['cannot be embedded', 'kann nicht eingebettet werden'],
  hint_logo_bad_option: ['Change the payload and try again.', 'Ändern Sie den Inhalt und versuchen Sie es noch einmal.'],
  problem_page_too_large: ['ran out of memory', 'hatte zu wenig Speicher'],
  hint_page_too_large: ['The command-line tool can use more memory than a page.', 'Das Kommandozeilenprogramm kann mehr Speicher nutzen als eine Seite.'],
  problem_page_io: ['could not load its detector', 'konnte ihren Detektor nicht laden'],
  hint_page_io: ['Reload the page; it must be served by a web server.', 'Laden Sie die Seite neu; sie muss von einem Webserver kommen.'],
  problem_page_internal: ['hit a fault of its own', 'stieß auf einen eigenen Fehler'],
  hint_page_internal: ['Nothing was decided about the model. Please report what you see here.', 'Über das Modell wurde nichts entschieden. Bitte melden Sie, was hier steht.'],

  andMore: [(n) => ` and ${n} more`, (n) => ` und ${n} weiteren`],
  missingTitle: [
    (n) => (n === 1 ? 'One more file is needed.' : `${n} more files are needed.`),
    (n) => (n === 1 ? 'Eine weitere Datei wird gebraucht.' : `${n} weitere Dateien werden gebraucht.`),
  ],
  missingText: [
    ({ modelName, list, one }) => `${modelName} keeps its geometry in ${list}, which ${one ? 'was' : 'were'} not among the files.`,
    ({ modelName, list, one }) => `${modelName} hat seine Geometrie in ${list}; ${one ? 'diese Datei war' : 'diese Dateien waren'} nicht dabei.`,
  ],
  missingHint: [
    (one) => `Drop ${one ? 'that file' : 'those files'} too, or the whole folder. This page never fetches anything by itself.`,
    (one) => `Legen Sie auch ${one ? 'diese Datei' : 'diese Dateien'} ab, oder den ganzen Ordner. Diese Seite holt nie etwas von selbst.`,
  ],
};
