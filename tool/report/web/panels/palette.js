/** Colours and dashes that tell replays apart. */
import { picture } from '../page/dom.js';

/* The colours of Okabe and Ito without yellow, which can hardly be seen on white. */
const LINES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8a94a0'];
const DASHES = [[], [7, 3], [2, 2], [9, 3, 2, 3], [4, 4]];

export function lineStyle(index) {
  return { colour: LINES[index % LINES.length], dash: DASHES[index % DASHES.length] };
}

/** A short piece of the line that stands for a replay. */
export function lineOf(index) {
  const { colour, dash } = lineStyle(index);
  const svg = picture(24, 8, 'line', {
    x1: 0,
    x2: 24,
    y1: 4,
    y2: 4,
    stroke: colour,
    'stroke-width': 2.5,
    'stroke-dasharray': dash.join(' ') || 'none',
  });
  svg.setAttribute('class', 'dash');
  return svg;
}
