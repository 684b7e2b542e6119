/** The states of intervals: what they mean, how often each is, and how a strip shows them. */
import { columnsOf, heaviest } from './columns.js';

/* From harmless to grave: where several intervals share a column the gravest shows. Told apart by height as well as by
 * colour, which the style sheet has. */
const HEIGHTS = { clean: 0.3, unknown: 0.5, contact: 0.7, penetrating: 1 };
const GRAVITY = Object.keys(HEIGHTS);

/** As tables and keys list them. */
const STATES = ['clean', 'contact', 'penetrating', 'unknown'];

export const STATE_MEANING = {
  clean: 'no contact, and the start does not cross itself',
  contact: 'there is contact',
  penetrating: 'the mesh crosses itself at the start',
  unknown: 'no contact; the start was not checked',
};

/** [state, count] of those that occur. @param {Iterable<object|undefined>} intervals */
export function countStates(intervals) {
  const counts = Object.fromEntries(STATES.map((state) => [state, 0]));
  for (const interval of intervals) if (interval?.state in counts) counts[interval.state]++;
  return Object.entries(counts).filter(([, count]) => count > 0);
}

/**
 * Draws the states of the intervals from begin to end along the lower edge of a canvas.
 * @param {(interval: number) => string|undefined} stateOf nothing is drawn where there is none
 * @param {number} height of the gravest state, in the canvas' pixels
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
