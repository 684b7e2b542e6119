/** The states of all intervals as a strip along the slider, with a tick where there are contacts. */

import { element } from '../page/dom.js';
import { finder } from '../page/intervals.js';
import { drawStates } from '../page/states.js';

/** Contacts are ticks above the strip, higher for more of them. */
function drawTicks(context, counts, place, height, ink) {
  const most = counts.reduce((largest, count) => Math.max(largest, count), 1); // more than a call takes arguments
  context.fillStyle = ink;
  counts.forEach((count, i) => {
    if (count === 0) return;
    const tall = Math.max(2, height * Math.sqrt(count / most));
    context.fillRect(place(i), height - tall, Math.max(1, place(i + 1) - place(i) - 0.5), tall);
  });
}

export function createBand(report, store, player) {
  const canvas = element('canvas', { class: 'band', 'aria-hidden': 'true' });
  const find = finder(report.summaries[0]?.summary);
  const intervals = player.last - player.first;
  const stateOf = (i) => find(player.first + i)?.state ?? 'unknown';

  function draw() {
    const density = window.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = canvas;
    if (clientWidth === 0) return;
    canvas.width = Math.round(clientWidth * density);
    canvas.height = Math.round(clientHeight * density);
    const strip = Math.min(6, clientHeight / 2);
    drawStates(canvas, 0, intervals, stateOf, strip * density);
    const context = canvas.getContext('2d');
    context.scale(density, density);
    const place = (i) => (i / intervals) * clientWidth;
    drawTicks(context, player.counts, place, clientHeight - strip - 1, getComputedStyle(canvas).color);
  }

  new ResizeObserver(draw).observe(canvas);
  store.on(['theme'], () => requestAnimationFrame(draw));
  return canvas;
}
