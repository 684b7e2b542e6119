/** A band over the charts that shows every interval's state. */
import { element } from '../page/dom.js';
import { counted } from '../page/format.js';
import { countStates, drawStates, STATE_MEANING, STATE_NAME } from '../page/states.js';

function key(counts) {
  const list = element('ul', { class: 'chart-keys' });
  for (const [state, count] of counts) {
    const words = element('span', { text: `${STATE_NAME[state]} ${count}` });
    const mark = element('span', { class: `state ${state}` }, element('i'), words);
    list.append(element('li', { title: STATE_MEANING[state] }, mark));
  }
  return list;
}

/** @param {(object|undefined)[]} intervals from the first on */
export function createStateBand(intervals) {
  const counts = countStates(intervals);
  const words = counts.map(([state, count]) => `${counted(count, 'interval')} ${STATE_NAME[state]}`).join(', ');
  const canvas = element('canvas', { role: 'img', 'aria-label': `States of the intervals: ${words}` });
  const timeLine = element('div', { class: 'time-line' });
  const track = element('div', { class: 'track' }, canvas, timeLine);
  const box = element('div', { class: 'state-band' }, key(counts), track);
  let range = [0, intervals.length];
  let time = 0;

  function moveLine() {
    const share = (time - range[0]) / (range[1] - range[0]);
    timeLine.hidden = !(share >= 0 && share <= 1);
    timeLine.style.transform = `translateX(${share * track.clientWidth}px)`;
  }

  function draw() {
    const scale = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(track.clientWidth * scale));
    canvas.height = Math.round(track.clientHeight * scale);
    drawStates(canvas, ...range, (i) => intervals[i]?.state, canvas.height);
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
    /** The moment, in intervals from the first. */
    setTime(at) {
      time = at;
      moveLine();
    },
  };
}
