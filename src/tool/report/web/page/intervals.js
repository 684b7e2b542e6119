/** Finds the interval of a moment, and what the summary says of it. */

/** @typedef {{first: number, last: number}} Extent in frames; a scene is one, too */

/** The first and last frame of what the report tells. @returns {Extent} */
export function extentOf(report) {
  if (report.scene) return report.scene;
  let first = Infinity;
  let last = -Infinity;
  for (const { summary } of report.summaries) {
    for (const { frame } of summary.intervals) {
      first = Math.min(first, frame);
      last = Math.max(last, frame + 1);
    }
  }
  return first < last ? { first, last } : { first: 0, last: 0 };
}

/** The interval of a time: its motion is linear. The last frame belongs to the interval before it. */
export function intervalAt(time, { first, last }) {
  return Math.max(first, Math.min(Math.floor(time), last - 1));
}

/** Returns a function from a frame to the interval's record; undefined if the replay ended before it. */
export function finder(summary) {
  const intervals = summary?.intervals ?? [];
  const first = intervals[0]?.frame ?? 0;
  const contiguous = intervals.every(({ frame }, i) => frame === first + i);
  if (contiguous) return (frame) => intervals[frame - first];
  const byFrame = new Map(intervals.map((interval) => [interval.frame, interval]));
  return (frame) => byFrame.get(frame);
}
