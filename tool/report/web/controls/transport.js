/** Buttons, slider and speed of the playback, with the intervals' states along the slider. */

import { createBand } from './band.js';
import { onCalmly } from './calm.js';
import { button, element, icon } from '../page/dom.js';
import { moment } from '../page/format.js';
import { lastAtOrBefore } from '../page/intervals.js';

const GLYPHS = {
  play: 'M4 2.5v11l9-5.5z',
  pause: 'M4 2.5h3v11H4zM9 2.5h3v11H9z',
  first: 'M3 3h1.8v10H3zM13 3v10L5.5 8z',
  last: 'M11.2 3H13v10h-1.8zM3 3v10l7.5-5z',
  previous: 'M11.5 3v10L4 8z',
  next: 'M4.5 3v10L12 8z',
  previousContact: 'M9 3v10L2 8zM12.5 5.7a2.3 2.3 0 1 1 0 4.6 2.3 2.3 0 0 1 0-4.6z',
  nextContact: 'M7 3v10l7-5zM3.5 5.7a2.3 2.3 0 1 1 0 4.6 2.3 2.3 0 0 1 0-4.6z',
  most: 'M2 9.5h2.5V14H2zM6.7 2h2.6v12H6.7zM11.5 6.5H14V14h-2.5z',
};

function playButton(store, player) {
  const made = button('Play', { glyph: GLYPHS.play, key: 'space', kind: 'primary icon' }, player.toggle);
  store.on(['playing'], ({ playing }) => {
    const name = playing ? 'Pause' : 'Play';
    made.setAttribute('aria-label', name);
    made.title = `${name} (space)`;
    made.replaceChildren(icon(playing ? GLYPHS.pause : GLYPHS.play));
  });
  return made;
}

function stepButtons(store, player) {
  const step = (name, glyph, key, action) => button(name, { glyph: GLYPHS[glyph], key }, action);
  const first = step('First frame', 'first', 'Home', player.toFirst);
  const previous = step('Previous frame', 'previous', '←', player.previous);
  const next = step('Next frame', 'next', '→', player.next);
  const last = step('Last frame', 'last', 'End', player.toLast);
  const before = step('Previous frame with contacts', 'previousContact', '[ or Shift ←', player.previousWithContacts);
  const after = step('Next frame with contacts', 'nextContact', '] or Shift →', player.nextWithContacts);
  const most = step('Frame with most contacts', 'most', 'M', player.toMost);
  const update = ({ time }) => {
    first.disabled = previous.disabled = time <= player.first;
    last.disabled = next.disabled = time >= player.last;
    before.disabled = player.frameWithContactsBefore(time) === null;
    after.disabled = player.frameWithContactsAfter(time) === null;
    most.disabled = player.most === null;
  };
  onCalmly(store, ['time'], update);
  update(store.get());
  return { before: [first, previous], after: [next, last], contacts: [before, after, most] };
}

function speedSelect(store, player) {
  const select = element('select', { 'aria-label': 'Speed', title: 'Frames a second (+ and −)' });
  for (const speed of player.speeds) select.append(element('option', { value: speed }, `${speed} frames/s`));
  select.value = String(store.get().speed);
  select.addEventListener('change', () => store.set({ speed: Number(select.value) }));
  store.on(['speed'], ({ speed }) => {
    select.value = String(speed);
  });
  return select;
}

function loopBox(store) {
  const input = element('input', { type: 'checkbox' });
  input.checked = store.get().loop;
  input.addEventListener('change', () => store.set({ loop: input.checked }));
  store.on(['loop'], ({ loop }) => {
    input.checked = loop;
  });
  return element('label', { class: 'choice' }, input, 'Loop');
}

function slider(store, player) {
  const input = element('input', {
    type: 'range',
    'aria-label': 'Frame',
    min: 0, // frames from the first: their numbers may have gaps, the band over the slider has none
    max: player.numbers.length - 1,
    step: 1,
    value: 0,
  });
  input.addEventListener('input', () => player.stepTo(player.numbers[Number(input.value)]));
  const update = ({ time }) => {
    const frame = Math.max(0, lastAtOrBefore(player.numbers, time));
    if (Number(input.value) !== frame) input.value = String(frame);
    input.setAttribute('aria-valuetext', String(player.numbers[frame]));
  };
  store.on(['time'], update);
  update(store.get());
  return input;
}

function clock(store, player) {
  const output = element('output', { class: 'number clock', 'aria-hidden': 'true' });
  const update = ({ time }) => {
    output.textContent = `${moment(time)} / ${player.last}`;
  };
  onCalmly(store, ['time'], update);
  update(store.get());
  return output;
}

export function createTransport(container, report, store, player) {
  const buttons = stepButtons(store, player);
  const looked = report.untangled === null; // for contacts and states, which strip and buttons are about
  const track = element('div', { class: looked ? 'scrub' : 'scrub bare' });
  track.append(...(looked ? [createBand(report, store, player)] : []), slider(store, player));
  const row = element('div', { class: 'row' });
  row.append(...buttons.before, playButton(store, player), ...buttons.after, ...(looked ? buttons.contacts : []));
  row.append(clock(store, player), element('span', { class: 'spacer' }), speedSelect(store, player), loopBox(store));
  container.append(track, row);
}
