/** The slider from before to after. */

import { element } from '../page/dom.js';

export function toggleShare(store) {
  store.set({ share: store.get().share < 0.5 ? 1 : 0 });
}

function end(name, share, store) {
  const made = element('button', { type: 'button', title: `${name} (A)` }, name);
  const update = (state) => made.setAttribute('aria-pressed', String(state.share === share));
  made.addEventListener('click', () => store.set({ share }));
  store.on(['share'], update);
  update(store.get());
  return made;
}

export function createShare(container, store) {
  const input = element('input', { type: 'range', 'aria-label': 'From before to after', min: 0, max: 1, step: 0.01 });
  const update = ({ share }) => {
    input.value = String(share);
    input.setAttribute('aria-valuetext', share === 0 ? 'before' : share === 1 ? 'after' : `${Math.round(100 * share)} % of the way`);
  };
  input.addEventListener('input', () => store.set({ share: Number(input.value) }));
  store.on(['share'], update);
  update(store.get());
  container.append(element('div', { class: 'share' }, end('Before', 0, store), input, end('After', 1, store)));
}
