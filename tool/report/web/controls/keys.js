/** Keys of the whole page, and the dialog that lists them. */

import { COLOURS, colourMissing, marksOf } from './choices.js';
import { element } from '../page/dom.js';
import { toggleShare } from './share.js';
import { zoomToContacts, zoomToMoves } from '../view/framing.js';

const HELP = [
  ['Space', 'Play or pause'],
  ['← →', 'Previous, next frame'],
  ['[ ] or Shift with ← →', 'Previous, next frame with contacts'],
  ['Home End', 'First, last frame'],
  ['M', 'Frame with most contacts'],
  ['N P', 'Next, previous event'],
  ['+ −', 'Faster, slower'],
  ['1 … 7', 'Colour by: plain, charge, equalized charge, region, orientation, contact heat, displacement'],
  ['A', 'Before or after, of what was untangled'],
  ['I C T X', 'Intersections, contacts, trail, through the surface'],
  ['D R E B', 'Detector points, region cuts, edges, surroundings'],
  ['Z', 'Zoom to the contacts of this interval, or to where vertices moved'],
  ['0', 'Reset the view'],
  ['S', 'Save the view as a picture'],
  ['L', 'Light or dark'],
  ['?', 'This help'],
  ['Esc', 'Unselect the contact and the triangle'],
];

const VIEW_HELP = [
  ['Drag', 'Turn (one finger)'],
  ['Drag with the right button', 'Pan (two fingers)'],
  ['Wheel', 'Zoom (pinch)'],
  ['Click', 'Select a contact, or tell about a triangle'],
  ['Alt with ← → ↑ ↓', 'Turn, while the view has the focus'],
  ['Alt Shift with ← → ↑ ↓', 'Pan'],
  ['Alt with Page Up, Page Down', 'Zoom'],
];

function keyList(title, rows) {
  const list = element('dl', { class: 'keys' });
  for (const [keys, text] of rows) list.append(element('dt', {}, element('kbd', {}, keys)), element('dd', {}, text));
  return [element('h3', {}, title), list];
}

export function createHelp() {
  const close = element('button', { type: 'button' }, 'Close');
  const dialog = element(
    'dialog',
    { class: 'help', 'aria-label': 'Keyboard help' },
    element('h2', {}, 'Keyboard and mouse'),
    ...keyList('Everywhere', HELP),
    ...keyList('In the 3D view', VIEW_HELP),
    close,
  );
  close.addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close(); // beside it
  });
  document.body.append(dialog);
  return { toggle: () => (dialog.open ? dialog.close() : dialog.showModal()), isOpen: () => dialog.open };
}

/** The element with the focus has its keys first: a list scrolls, a radio group moves by arrows. */
function takenByFocus(event) {
  const { target, key } = event;
  if (!(target instanceof Element)) return false;
  if (target.closest('input[type=text], input[type=search], input[type=number], textarea, select, [contenteditable]')) {
    return true;
  }
  const arrows = key.startsWith('Arrow') || key === 'Home' || key === 'End';
  if (arrows && target.closest('input[type=radio], input[type=range], [role=tablist], [data-arrows]')) {
    return !event.shiftKey;
  }
  return key === ' ' && target.closest('button, a, summary, input[type=checkbox], input[type=radio]') !== null;
}

function playbackKeys(player) {
  return {
    ' ': player.toggle,
    ArrowLeft: player.previous,
    ArrowRight: player.next,
    'Shift+ArrowLeft': player.previousWithContacts,
    'Shift+ArrowRight': player.nextWithContacts,
    '[': player.previousWithContacts,
    ']': player.nextWithContacts,
    Home: player.toFirst,
    End: player.toLast,
    m: player.toMost,
    n: () => player.stepEvent(1),
    p: () => player.stepEvent(-1),
    '+': player.faster,
    '=': player.faster,
    '-': player.slower,
  };
}

function sceneKeys(scene, store, viewer) {
  const actions = {
    0: () => viewer?.home(),
    z: () => viewer && (scene.displacement === null ? zoomToContacts : zoomToMoves)(viewer),
    s: () => viewer?.savePicture(),
    Escape: () => store.set({ selected: null, triangle: null }),
  };
  if (scene.displacement !== null) actions.a = () => toggleShare(store);
  COLOURS.forEach((colour, i) => {
    if (colourMissing(scene, viewer !== null, colour) !== null) return;
    actions[String(i + 1)] = () => store.set({ colour: colour.value });
  });
  for (const { key, letter, missing } of marksOf(scene, viewer !== null)) {
    if (missing === null) actions[letter.toLowerCase()] = () => store.set({ [key]: !store.get()[key] });
  }
  return actions;
}

export function listenToKeys({ report, store, player, viewer, theme, help }) {
  const { scene } = report;
  const actions = { l: theme.toggle, '?': help.toggle };
  if (scene !== null) Object.assign(actions, sceneKeys(scene, store, viewer));
  if (scene !== null && scene.last > scene.first) Object.assign(actions, playbackKeys(player));
  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    if (takenByFocus(event) || (help.isOpen() && event.key !== '?')) return;
    const shifted = event.shiftKey && event.key.startsWith('Arrow') ? 'Shift+' : '';
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = actions[shifted + key];
    if (action === undefined) return;
    event.preventDefault();
    action();
  });
}
