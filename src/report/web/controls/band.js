/** The states of all intervals as a strip along the slider, with a tick where there are contacts. */

import { element } from './dom.js';

/** Told apart by height as well as by colour, which the style sheet has. */
const HEIGHTS = { clean: 0.4, contact: 0.7, penetrating: 1, unknown: 0.7 };

const stateOf = (row) => (row?.state in HEIGHTS ? row.state : 'unknown');

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
  const rows = new Map((report.summaries[0]?.summary.intervals ?? []).map((row) => [row.frame, row]));
  const intervals = player.last - player.first;

  function draw() {
    const density = window.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = canvas;
    if (clientWidth === 0) return;
    canvas.width = Math.round(clientWidth * density);
    canvas.height = Math.round(clientHeight * density);
    const context = canvas.getContext('2d');
    context.scale(density, density);
    const place = (i) => (i / intervals) * clientWidth;
    const strip = Math.min(6, clientHeight / 2);
    const style = getComputedStyle(canvas);
    const colours = {};
    for (const state of Object.keys(HEIGHTS)) colours[state] = style.getPropertyValue(`--state-${state}`);
    drawTicks(context, player.counts, place, clientHeight - strip - 1, style.color);
    for (let i = 0; i < intervals; i++) {
      const state = stateOf(rows.get(player.first + i));
      const height = strip * HEIGHTS[state];
      context.fillStyle = colours[state];
      context.fillRect(place(i), clientHeight - height, place(i + 1) - place(i) + 0.3, height);
    }
  }

  new ResizeObserver(draw).observe(canvas);
  store.on(['theme'], () => requestAnimationFrame(draw));
  return canvas;
}
