/** The frame in the address, as `#frame=24`: read when the page opens or the address changes, and written when the frame rests. */

import { lastAtOrBefore } from '../page/intervals.js';

/** The frame that the address names, or the one before if there is none of this number; null where it names none. */
export function frameInAddress({ numbers }) {
  const match = /(?:^#|&)frame=(-?\d+)(?:&|$)/.exec(window.location.hash);
  return match === null ? null : numbers[Math.max(0, lastAtOrBefore(numbers, Number(match[1])))];
}

/** Changes the address without a new entry in the history. */
function write(frame) {
  const hash = `#frame=${frame}`;
  if (window.location.hash === hash) return;
  try {
    window.history.replaceState(null, '', hash);
  } catch {
    // an address that the browser does not let pages change stays as it is
  }
}

export function followAddress(scene, store) {
  store.on(['time', 'playing'], ({ time, playing }) => {
    if (!playing) write(scene.numbers[Math.max(0, lastAtOrBefore(scene.numbers, time))]);
  });
  window.addEventListener('hashchange', () => {
    const frame = frameInAddress(scene);
    if (frame !== null) store.set({ time: frame, playing: false, selected: null });
  });
}
