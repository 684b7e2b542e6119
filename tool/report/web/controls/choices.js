/** Controls of the view: one colouring, and the marks over it. Those that only the method has are folded. */

import { element } from '../page/dom.js';

export const COLOURS = [
  { value: 'plain', name: 'Plain' },
  { value: 'charge', name: 'Charge', array: 'charge', method: true },
  { value: 'equalized', name: 'Equalized charge', array: 'equalized', method: true },
  { value: 'region', name: 'Region', array: 'region', method: true },
  { value: 'orientation', name: 'Orientation', array: 'orientation', method: true },
  { value: 'heat', name: 'Contact heat', array: 'heat' },
  { value: 'displacement', name: 'Displacement', array: 'displacement' },
];

const TRAIL = 'Contacts of the 8 intervals before, fading';
const THROUGH_BOTH = 'What intersects where the surface hides it, faintly';
const THROUGH = 'Contacts that the surface hides, faintly';
const NO_VIEW = 'The 3D view, where this would show, cannot be drawn: the browser offers no WebGL';
const NO_PLAN = 'The recording was searched without regions, so the report has none';
const REASONS = {
  charge: 'The report has no charge: the mesh is not closed, or the method needs none',
  equalized: 'The report has no charge: the mesh is not closed, or the method needs none',
  region: NO_PLAN,
  orientation: 'The report has no orientations: the method has none, or the recording is too long to keep them',
  heat: 'The report has no contacts: nothing was replayed',
  displacement: 'The report does not show it before and after',
};

const NO_ANSWERS = 'The frames of this report were not checked';

/** Where it is shown before and after, nothing else was looked for. */
function marksOfPair(scene) {
  const missing = scene.answers === null ? NO_ANSWERS : null;
  return [
    { key: 'answers', name: 'Intersections', letter: 'I', missing },
    { key: 'through', name: 'Through the surface', letter: 'X', missing, title: THROUGH_BOTH },
    { key: 'edges', name: 'Edges', letter: 'E', missing: null },
  ];
}

function marksOfScene(scene) {
  if (scene.displacement !== null) return marksOfPair(scene);
  const noContacts = scene.contacts === null ? REASONS.heat : null;
  const noPoints = scene.detectorPoints === null && scene.plan === null ? NO_PLAN : null;
  return [
    { key: 'answers', name: 'Intersections', letter: 'I', missing: scene.answers === null ? NO_ANSWERS : null },
    { key: 'contacts', name: 'Contacts', letter: 'C', missing: noContacts },
    { key: 'trail', name: 'Trail', letter: 'T', missing: noContacts, title: TRAIL },
    { key: 'through', name: 'Through the surface', letter: 'X', missing: noContacts, title: THROUGH },
    { key: 'points', name: 'Detector points', letter: 'D', missing: noPoints, title: 'From where each region is seen', method: true },
    { key: 'cuts', name: 'Region cuts', letter: 'R', missing: scene.region === null ? NO_PLAN : null, method: true },
    { key: 'edges', name: 'Edges', letter: 'E', missing: null },
    {
      key: 'scenery',
      name: 'Surroundings',
      letter: 'B',
      missing: scene.scenery === null ? 'The report was written without --scenery' : null,
    },
  ];
}

/**
 * @param {boolean} drawn whether there is a view that can show them
 * @returns {{key: string, name: string, letter: string, missing: string|null}[]} missing: why it cannot be chosen
 */
export function marksOf(scene, drawn) {
  const marks = marksOfScene(scene);
  return drawn ? marks : marks.map((mark) => ({ ...mark, missing: NO_VIEW }));
}

/** Why the colouring cannot be chosen, or null. */
export function colourMissing(scene, drawn, { array, value }) {
  if (!drawn) return NO_VIEW;
  return array !== undefined && scene[array] === null ? REASONS[value] : null;
}

function choice(input, name, key, title) {
  const label = element('label', { class: 'choice', title }, input, name);
  if (input.disabled) label.setAttribute('data-disabled', '');
  label.append(element('kbd', { 'aria-hidden': 'true' }, key));
  return label;
}

/** @param {(one: {method?: boolean}) => boolean} listed which of them this group has */
function colourChoices(scene, drawn, store, title, listed) {
  const group = element('fieldset', { class: 'choices', role: 'radiogroup', 'aria-label': title });
  group.append(element('legend', {}, title));
  COLOURS.forEach((colour, i) => {
    if (!listed(colour)) return;
    const missing = colourMissing(scene, drawn, colour);
    const input = element('input', {
      type: 'radio',
      name: 'colour',
      value: colour.value,
      'aria-label': colour.name,
      disabled: missing !== null,
      title: missing,
    });
    const update = (state) => {
      input.checked = state.colour === colour.value;
    };
    input.addEventListener('change', () => store.set({ colour: colour.value }));
    store.on(['colour'], update);
    update(store.get());
    group.append(choice(input, colour.name, String(i + 1), missing));
  });
  return group;
}

function markChoices(scene, drawn, store, heading, listed) {
  const group = element('fieldset', { class: 'choices', 'aria-label': heading });
  group.append(element('legend', {}, heading));
  for (const { key, name, letter, missing, title = null } of marksOf(scene, drawn).filter(listed)) {
    const input = element('input', {
      type: 'checkbox',
      'aria-label': name,
      disabled: missing !== null,
      title: missing ?? title,
    });
    const update = (state) => {
      input.checked = missing === null && state[key];
    };
    input.addEventListener('change', () => store.set({ [key]: input.checked }));
    store.on([key], update);
    update(store.get());
    group.append(choice(input, name, letter, missing ?? title));
  }
  return group;
}

function upSelect(drawn, store) {
  const select = element('select', { 'aria-label': 'Up axis', disabled: !drawn, title: drawn ? null : NO_VIEW });
  for (const axis of ['z', 'y']) select.append(element('option', { value: axis }, axis));
  select.value = store.get().up;
  select.addEventListener('change', () => store.set({ up: select.value }));
  store.on(['up'], ({ up }) => {
    select.value = up;
  });
  return element('label', { class: 'row' }, 'Up axis', select);
}

/** Colours and marks of charge, regions and orientations; a key that chooses a colour unfolds them. */
function methodChoices(scene, drawn, store, open) {
  const box = element('details', { class: 'method-choices', open });
  box.append(
    element('summary', {}, 'Method: charge, regions, orientations'),
    colourChoices(scene, drawn, store, 'Colour by the method', ({ method }) => method),
    markChoices(scene, drawn, store, 'Show of the method', ({ method }) => method),
  );
  store.on(['colour'], ({ colour }) => {
    if (COLOURS.find(({ value }) => value === colour).method) box.open = true;
  });
  return box;
}

/**
 * @param {boolean} drawn whether there is a view
 * @param {boolean} open whether the method is what the report is about
 */
export function createChoices(container, scene, drawn, store, open) {
  const common = ({ method }) => !method;
  const paired = scene.displacement !== null;
  const colours = ({ method, value }) => (paired ? ['plain', 'displacement'].includes(value) : !method && value !== 'displacement');
  container.append(
    colourChoices(scene, drawn, store, 'Colour by', colours),
    markChoices(scene, drawn, store, 'Show', common),
    upSelect(drawn, store),
    ...(paired ? [] : [methodChoices(scene, drawn, store, open)]),
  );
}
