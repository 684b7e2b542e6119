/** A band over the charts that shows every interval's state. */
import { element } from './dom.js';
import { counted } from './format.js';
import { STATE_MEANING, STATES } from './stages.js';

/* Where several intervals share a pixel the graver state shows. */
const GRAVITY = { clean: 0, unknown: 1, contact: 2, penetrating: 3 };
const HEIGHT = { clean: 0.3, unknown: 0.3, contact: 0.65, penetrating: 1 };

function key(intervals) {
  const list = element('ul', { class: 'chart-keys' });
  for (const state of STATES) {
    const count = intervals.filter((interval) => interval?.state === state).length;
    if (count === 0) continue;
    list.append(
      element(
        'li',
        { title: STATE_MEANING[state] },
        element(
          'span',
          { class: `state ${state}` },
          element('i'),
          element('span', { text: `${state} ${count}` }),
        ),
      ),
    );
  }
  return list;
}

/** @param {(object|undefined)[]} intervals from the first on */
export function createStateBand(intervals) {
  const counts = STATES.map((state) => [
    state,
    intervals.filter((interval) => interval?.state === state).length,
  ]);
  const words = counts
    .filter(([, count]) => count > 0)
    .map(([state, count]) => `${counted(count, 'interval')} ${state}`)
    .join(', ');
  const canvas = element('canvas', { role: 'img', 'aria-label': `States of the intervals: ${words}` });
  const timeLine = element('div', { class: 'time-line' });
  const track = element('div', { class: 'track' }, canvas, timeLine);
  const box = element('div', { class: 'state-band' }, key(intervals), track);
  let range = [0, intervals.length];
  let time = 0;

  function gravest(begin, end) {
    let found = intervals[begin]?.state;
    for (let i = begin + 1; i < end; i++) {
      const state = intervals[i]?.state;
      if ((GRAVITY[state] ?? -1) > (GRAVITY[found] ?? -1)) found = state;
    }
    return found;
  }

  function moveLine() {
    const share = (time - range[0]) / (range[1] - range[0]);
    timeLine.hidden = !(share >= 0 && share <= 1);
    timeLine.style.transform = `translateX(${share * track.clientWidth}px)`;
  }

  function draw() {
    const scale = window.devicePixelRatio || 1;
    const width = (canvas.width = Math.max(1, Math.round(track.clientWidth * scale)));
    const height = (canvas.height = Math.round(track.clientHeight * scale));
    const context = canvas.getContext('2d');
    const style = getComputedStyle(document.documentElement);
    const count = range[1] - range[0];
    const columns = Math.min(count, width);
    for (let column = 0; column < columns; column++) {
      const begin = range[0] + Math.floor((column * count) / columns);
      const end = range[0] + Math.floor(((column + 1) * count) / columns);
      const state = gravest(begin, Math.max(end, begin + 1));
      if (state === undefined) continue;
      const left = Math.floor((column * width) / columns);
      const high = Math.round(HEIGHT[state] * height);
      context.fillStyle = style.getPropertyValue(`--state-${state}`);
      context.fillRect(left, height - high, Math.ceil(((column + 1) * width) / columns) - left, high);
    }
    moveLine();
  }

  return {
    box,
    track,
    draw,
    setRange(begin, end) {
      range = [begin, end];
      draw();
    },
    /** In intervals from the first. */
    setTime(at) {
      time = at;
      moveLine();
    },
  };
}
