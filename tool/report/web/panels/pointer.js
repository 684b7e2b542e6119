/** The pointer on a chart: hovering shows the values of an interval, a click or drag goes to it. */

/**
 * @param {HTMLElement} surface over which the intervals extend from its left to its right
 * @param {{range: () => [number, number], hover: (interval: number|null) => void,
 *          go: (interval: number) => void}} chart
 */
export function followPointer(surface, { range, hover, go }) {
  const intervalUnder = (event) => {
    const box = surface.getBoundingClientRect();
    const [begin, end] = range();
    const share = box.width > 0 ? (event.clientX - box.left) / box.width : 0;
    return Math.max(begin, Math.min(end - 1, begin + Math.floor(share * (end - begin))));
  };
  surface.addEventListener('pointermove', (event) => {
    hover(intervalUnder(event));
    if (event.buttons & 1) go(intervalUnder(event));
  });
  surface.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    surface.setPointerCapture(event.pointerId);
    go(intervalUnder(event));
  });
  surface.addEventListener('pointerleave', () => hover(null));
  surface.addEventListener('pointercancel', () => hover(null));
}
