/** The states of intervals: what they mean, how often each is, and how a strip shows them. */
import { columnsOf, heaviest } from './columns.js';

/* The worst state is the highest, and is shown where several intervals share a column. States differ in height as well
 * as in colour, which the style sheet has. */
const HEIGHTS = { clean: 0.3, unknown: 0.5, contact: 0.7, penetrating: 1 };
const GRAVITY = Object.keys(HEIGHTS);

/** The order of tables and keys. */
const STATES = ['clean', 'contact', 'penetrating', 'unknown'];

/** Words of the page for the states of the summary. */
export const STATE_NAME = {
  clean: 'clean',
  contact: 'contact',
  penetrating: 'intersecting',
  unknown: 'unknown',
};

export const STATE_MEANING = {
  clean: 'no contact, and the mesh does not intersect itself at the start',
  contact: 'there is contact',
  penetrating: 'the mesh intersects or touches itself at the start',
  unknown: 'no contact; the start was not checked',
};

/** [state, count] of the states that occur. @param {Iterable<object|undefined>} intervals */
export function countStates(intervals) {
  const counts = Object.fromEntries(STATES.map((state) => [state, 0]));
  for (const interval of intervals) if (interval?.state in counts) counts[interval.state]++;
  return Object.entries(counts).filter(([, count]) => count > 0);
}

/**
 * Draws the states of the intervals from begin to end along the lower edge of a canvas.
 * @param {(interval: number) => string|undefined} stateOf nothing is drawn where there is none
 * @param {number} height of the worst state, in pixels of the canvas
 */
export function drawStates(canvas, begin, end, stateOf, height) {
  const context = canvas.getContext('2d');
  const style = getComputedStyle(canvas);
  const colours = Object.fromEntries(
    GRAVITY.map((state) => [state, style.getPropertyValue(`--state-${state}`)]),
  );
  const gravity = (interval) => GRAVITY.indexOf(stateOf(interval));
  for (const column of columnsOf(begin, end, canvas.width)) {
    const state = stateOf(heaviest(column.begin, column.end, gravity));
    if (!(state in HEIGHTS)) continue;
    const high = Math.round(HEIGHTS[state] * height);
    context.fillStyle = colours[state];
    context.fillRect(column.left, canvas.height - high, column.right - column.left, high);
  }
}
