/** The states of all intervals as a strip along the slider, with a tick where there are contacts. */

import { columnsOf, heaviest } from '../page/columns.js';
import { element } from '../page/dom.js';
import { finder } from '../page/intervals.js';
import { drawStates } from '../page/states.js';

/** Contacts are ticks above the strip, higher for more contacts. Intervals that share a column show the highest. */
function drawTicks(canvas, counts, strip, ink) {
  const context = canvas.getContext('2d');
  const most = counts.reduce((largest, count) => Math.max(largest, count), 1); // more than a call takes arguments
  const bottom = canvas.height - strip;
  const density = window.devicePixelRatio || 1;
  context.fillStyle = ink;
  for (const { begin, end, left, right } of columnsOf(0, counts.length, canvas.width)) {
    const count = counts[heaviest(begin, end, (i) => counts[i])];
    if (count === 0) continue;
    const tall = Math.max(2 * density, bottom * Math.sqrt(count / most));
    const gap = right - left > 2 * density ? Math.round(0.5 * density) : 0;
    context.fillRect(left, bottom - tall, right - left - gap, tall);
  }
}

export function createBand(report, store, player) {
  const canvas = element('canvas', { class: 'band', 'aria-hidden': 'true' });
  const find = finder(report.summaries[0]?.summary);
  const intervals = player.counts.length;
  const stateOf = (i) => find(player.numbers[i])?.state ?? 'unknown';

  function draw() {
    const density = window.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = canvas;
    if (clientWidth === 0) return;
    canvas.width = Math.round(clientWidth * density);
    canvas.height = Math.round(clientHeight * density);
    const strip = Math.min(6, clientHeight / 2) * density;
    drawStates(canvas, 0, intervals, stateOf, strip);
    drawTicks(canvas, player.counts, strip + density, getComputedStyle(canvas).color);
  }

  new ResizeObserver(draw).observe(canvas);
  store.on(['theme'], () => requestAnimationFrame(draw));
  return canvas;
}
