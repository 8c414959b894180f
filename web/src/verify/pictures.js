// SPDX-License-Identifier: MIT
// The extracted picture, the reference beside it, and how sure each pixel is.
import { $ } from '../dom.js';
import { percent, t, wholeWords } from '../words/language.js';

export const countOnes = (bits) => bits.reduce((sum, bit) => sum + bit, 0);
const pixels = (n) => t('pixels', { n, text: wholeWords(n) });

/** Pixels that were read, and read otherwise than the reference has them. */
function differing(image, reference) {
  let n = 0;
  image.bits.forEach((bit, i) => { if (!image.erased[i] && bit !== reference.bits[i]) ++n; });
  return n;
}

function fill(id, url, alt) {
  $(id).src = url;
  $(id).alt = alt;
}

function showReference({ image, reference }, urls) {
  fill('reference', urls.of(reference.png, 'image/png'), t('referenceAlt', t('bySize', reference)));
  $('agreement').textContent = '';
  if (image.width !== reference.width || image.height !== reference.height) {
    $('reference-caption').textContent = t('otherSize', image);
    return;
  }
  const unread = countOnes(image.erased);
  const wrong = differing(image, reference);
  const read = image.bits.length - unread;
  $('reference-caption').textContent = wrong === 0 && unread === 0 ? t('sameEverywhere') : t('differsIn', { wrong: pixels(wrong), read: wholeWords(read) });
  if (read > 0) $('agreement').textContent = t('agreement', percent(Math.floor(1000 * (read - wrong) / read) / 1000));
}

/** @param urls  Urls that live as long as the result is shown */
export function showPictures(result, urls) {
  const { image, reference, verdict, isId } = result;
  $('pictures').hidden = image === null;
  if (image === null) return;  // an ID, a text, or nothing
  const unread = countOnes(image.erased);
  const size = t('bySize', image);
  const none = verdict === 'none';
  const share = percent(result.averageConfidence);
  const withReference = Boolean(reference) && !isId;
  $('pictures').classList.toggle('of-id', isId);
  $('pictures').classList.toggle('with-reference', withReference);
  $('image-figure').hidden = isId;
  // The confidence is that of a mark which is there: beside noise it would claim a certainty that nothing has. Where all
  // is certain there is nothing to draw.
  $('confidence-figure').hidden = none || result.averageConfidence > 0.9995;
  $('confidence-title').textContent = t('sureTitle', isId);
  $('confidence-caption').textContent = t('sureAverage', share);
  fill('confidence', urls.of(image.confidencePng, 'image/png'), t('sureAlt', { bit: isId, share }));
  if (!isId) {
    fill('image', urls.of(image.png, 'image/png'), t(none ? 'noiseAlt' : 'extractedAlt', size));
    $('image-caption').textContent = none ? t('noiseCaption') : `${image.width} × ${image.height}${unread > 0 ? t('unread', pixels(unread)) : ''}`;
  }
  $('reference-figure').hidden = !withReference;
  if (withReference) showReference(result, urls);
}
