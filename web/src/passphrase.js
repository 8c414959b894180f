// SPDX-License-Identifier: MIT
// The small form that turns a passphrase into a key.
import { element } from './dom.js';
import { Engine } from './engine.js';
import { LEAST_PASSPHRASE } from 'quadmark/passphrase';
import { t } from './words/language.js';

/**
 * @param root   where the form goes
 * @param prefix of its ids
 * @param onKey  ({ key, label }) => void
 */
export function passphraseForm(root, prefix, onKey) {
  const engine = new Engine();
  const field = (name, text, type, autocomplete) => {
    const input = element('input', { type, id: `${prefix}-${name}`, autocomplete, maxlength: 300 });
    return [element('label', { for: input.id, 'data-t': text }), input];
  };
  const [ownerLabel, owner] = field('owner', 'passphraseOwner', 'text', 'organization');
  const [phraseLabel, phrase] = field('passphrase', 'passphrase', 'password', 'off');
  const button = element('button', { type: 'button', id: `${prefix}-use`, 'data-t': 'passphraseUse' });
  const status = element('p', { class: 'faint', role: 'status' });
  root.append(element('div', { class: 'field' }, ownerLabel, owner, phraseLabel, phrase, button,
    element('p', { class: 'faint', 'data-t': 'passphraseHelp' }), status));

  const derive = async () => {
    if ([...phrase.value.normalize('NFKC')].length < LEAST_PASSPHRASE) {
      status.textContent = t('passphraseShort');
      phrase.focus();
      return;
    }
    status.textContent = t('deriving');
    const answer = await engine.run({ job: 'derive', passphrase: phrase.value, owner: owner.value.trim() }).catch(() => null);
    if (answer === null) return;  // a newer one replaced it
    status.textContent = answer.type === 'result' ? '' : answer.message;
    if (answer.type === 'result') onKey({ key: answer.key, label: t('fromPassphrase', answer.key.owner) });
  };
  button.addEventListener('click', derive);
  phrase.addEventListener('keydown', (event) => {
    if (event.key !== 'Enter') return;
    event.preventDefault();  // of a form around it
    derive();
  });
}
