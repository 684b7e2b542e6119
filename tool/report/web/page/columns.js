/** Many intervals on few pixels: at most one column for each pixel. */

/**
 * @param {number} width in pixels
 * @returns {{begin: number, end: number, left: number, right: number}[]} the intervals from begin to end of each
 *   column and its edges, whole pixels
 */
export function columnsOf(begin, end, width) {
  const count = end - begin;
  const columns = Math.min(count, Math.max(1, width));
  return Array.from({ length: columns }, (_, column) => ({
    begin: begin + Math.floor((column * count) / columns),
    end: begin + Math.floor(((column + 1) * count) / columns),
    left: Math.floor((column * width) / columns),
    right: Math.ceil(((column + 1) * width) / columns),
  }));
}

/** The number from begin to end that has the most weight; the first of several. */
export function heaviest(begin, end, weight) {
  let best = begin;
  let most = weight(begin);
  for (let i = begin + 1; i < end; i++) {
    const own = weight(i);
    if (own <= most) continue;
    best = i;
    most = own;
  }
  return best;
}
