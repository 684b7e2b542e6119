/** Finds the interval of a moment, and what the summary says of it. Frames are called by the artist's numbers: ascending
 * integers of any step, which may have gaps and begin below 0. A *place* counts intervals from the first, with a fraction. */

/** @typedef {{first: number, last: number, numbers: ArrayLike<number>}} Extent the number of each frame; a scene is one, too */

/** The last element at or before a value; -1 where there is none. */
export function lastAtOrBefore(ascending, value) {
  let low = 0;
  let high = ascending.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ascending[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** The last frame of a replay that has intervals. */
export function lastFrameOf({ intervals, frames }) {
  const begin = intervals[intervals.length - 1].frame;
  return frames?.find(({ frame }) => frame > begin)?.frame ?? begin + 1;
}

/** The numbers of all frames that some replay has. */
function numbersOf(summaries) {
  const numbers = new Set();
  for (const { summary } of summaries) {
    for (const { frame } of summary.intervals) numbers.add(frame);
    if (summary.intervals.length > 0) numbers.add(lastFrameOf(summary));
  }
  return [...numbers].sort((a, b) => a - b);
}

/** The frames that the report tells of. @returns {Extent} */
export function extentOf(report) {
  if (report.scene) return report.scene;
  const numbers = numbersOf(report.summaries);
  return { numbers, first: numbers[0] ?? 0, last: numbers[numbers.length - 1] ?? 0 };
}

/** How many intervals there are. */
export const intervalCount = ({ numbers }) => Math.max(0, numbers.length - 1);

/** The interval of a time, counted from the first. The last frame belongs to the interval before it. */
export function intervalIndexAt(time, { numbers }) {
  return Math.max(0, Math.min(lastAtOrBefore(numbers, time), numbers.length - 2));
}

/** The interval of a time, by the frame that it begins with: its motion is linear. */
export function intervalAt(time, extent) {
  return extent.numbers[intervalIndexAt(time, extent)] ?? extent.first;
}

/** How far a time is on the way through its interval, 0 to 1. */
export function fractionAt(time, extent) {
  const i = intervalIndexAt(time, extent);
  const { numbers } = extent;
  return numbers.length < 2 ? 0 : (time - numbers[i]) / (numbers[i + 1] - numbers[i]);
}

/** The place of a time. */
export const placeOf = (time, extent) => intervalIndexAt(time, extent) + fractionAt(time, extent);

/** The time of a moment of the interval that begins with a frame. */
export function timeWithin(interval, fraction, { numbers }) {
  const i = lastAtOrBefore(numbers, interval);
  return interval + fraction * ((numbers[i + 1] ?? interval) - interval);
}

const frameLists = new WeakMap();

/** Returns a function from a frame to the interval's record; undefined if the replay ended before it. */
export function finder(summary) {
  const intervals = summary?.intervals ?? [];
  if (!frameLists.has(intervals)) frameLists.set(intervals, Float64Array.from(intervals, ({ frame }) => frame));
  const frames = frameLists.get(intervals);
  let next = 0; // most callers ask for one after the other
  return (frame) => {
    const i = frames[next] === frame ? next : lastAtOrBefore(frames, frame);
    next = i + 1;
    return frames[i] === frame ? intervals[i] : undefined;
  };
}
