/** The charts under the view. They show every interval and the current moment; a click goes to an interval. */
import { onCalmly } from '../controls/calm.js';
import { element, heading, setText } from '../page/dom.js';
import { createFigure } from './figure.js';
import { compareFigures, replayFigures } from './figures.js';
import { extentOf, finder, intervalCount, intervalIndexAt, placeOf } from '../page/intervals.js';
import { followPointer } from './pointer.js';
import { createStateBand } from './stateband.js';

const ZOOMED_FROM = 60; /* fewer intervals need no zoom */

/** How many intervals a chart shows of a long recording. */
function createRange(count, changed) {
  let [begin, end] = [0, count];
  const clamp = (from, length) => {
    const size = Math.max(20, Math.min(count, Math.round(length)));
    begin = Math.max(0, Math.min(count - size, Math.round(from)));
    end = begin + size;
    changed(begin, end);
  };
  return {
    get: () => [begin, end],
    all: () => clamp(0, count),
    /** Zooms about a moment, which keeps its place. */
    scale(factor, at) {
      const share = at >= begin && at <= end ? (at - begin) / (end - begin) : 0.5;
      const length = (end - begin) * factor;
      clamp((at >= begin && at <= end ? at : (begin + end) / 2) - share * length, length);
    },
    /** Turns the page when playing leaves it. */
    contain(at) {
      if (at >= begin && at <= end) return;
      clamp(at < begin ? at - (end - begin) * 0.9 : at - (end - begin) * 0.1, end - begin);
    },
  };
}

function rangeButtons(range, moment) {
  const button = (text, label, act) =>
    element('button', { type: 'button', text, 'aria-label': label, title: label, onclick: act });
  return element(
    'span',
    { class: 'chart-range' },
    button('−', 'Zoom charts out', () => range.scale(2, moment())),
    button('+', 'Zoom charts in', () => range.scale(0.5, moment())),
    button('All', 'All intervals in the charts', () => range.all()),
  );
}

const CUT = 'Peaks of 2 % of the intervals go beyond the top, so that the others can be told apart';

/** Switches of the vertical scale; change({logarithmic, cut}). */
function scaleSwitches(compares, change) {
  const box = (onchange) => element('input', { type: 'checkbox', onchange });
  const tell = () => change({ logarithmic: logarithmic.checked, cut: cut.checked });
  const logarithmic = box(tell);
  const cut = box(tell);
  const labels = [element('label', { class: 'choice', title: CUT }, cut, 'Cut peaks')];
  if (compares) labels.push(element('label', { class: 'choice' }, logarithmic, 'Logarithmic'));
  return labels;
}

export function create(container, report, store, player) {
  const extent = extentOf(report);
  const { numbers } = extent;
  const count = intervalCount(extent);
  container.hidden = report.kind === 'preprocess' || report.untangled !== null || count < 1;
  if (container.hidden) return;
  const compares = report.kind === 'compare';
  const finders = report.summaries.map(({ summary }) => finder(summary));
  const figures = (compares ? compareFigures : replayFigures)(report, numbers, finders).map((figure) =>
    createFigure({ ...figure, numbers }),
  );
  const band = compares
    ? null
    : createStateBand(Array.from({ length: count }, (_, i) => finders[0](numbers[i])));
  let plots = [];
  let hovered = null;
  let read = -1;
  const reading = element('output', {
    class: 'reading',
    'aria-live': 'off',
    title: 'The interval whose values are shown: under the pointer, else the current one',
  });

  const moment = () => placeOf(store.get().time, extent);
  const range = createRange(count, (begin, end) => {
    plots.forEach((plot) => plot.setRange(begin, end));
    band?.setRange(begin, end);
  });

  function readValues() {
    const interval = hovered ?? intervalIndexAt(store.get().time, extent);
    if (interval === read) return;
    read = interval;
    setText(reading, `frame ${numbers[interval]}`);
    figures.forEach((figure) => figure.show(interval));
  }

  function hover(interval) {
    hovered = interval;
    plots.forEach((plot) => plot.setHover(interval === null ? null : interval + 0.5));
    readValues();
  }

  function go(interval) {
    if (player) player.stepTo(numbers[interval]);
    else store.set({ time: numbers[interval] });
  }

  function follow({ time }) {
    const place = placeOf(time, extent);
    range.contain(place);
    plots.forEach((plot) => plot.setTime(place));
    band?.setTime(place);
  }

  function draw() {
    const attach = (surface) => followPointer(surface, { range: range.get, hover, go });
    plots = figures.map((figure) => figure.draw(attach));
    if (band) attach(band.track);
    band?.draw();
    follow(store.get());
    readValues();
  }

  const told = player ? 'click or drag to go there; values of ' : 'values of ';
  const beside = [element('span', { class: 'quiet' }, told, reading)];
  beside.push(...scaleSwitches(compares, (scale) => plots.forEach((plot) => plot.setScale(scale))));
  if (count >= ZOOMED_FROM) beside.push(rangeButtons(range, moment));
  container.append(
    heading('Charts', ...beside),
    ...(band ? [band.box] : []),
    ...figures.map(({ box }) => box),
  );
  draw();
  new ResizeObserver(() => {
    plots.forEach((plot) => plot.resize());
    band?.draw();
  }).observe(container);
  store.on(['time'], follow);
  onCalmly(store, ['time'], readValues);
  store.on(['theme'], () =>
    requestAnimationFrame(() => {
      plots.forEach((plot) => plot.recolour());
      band?.draw();
    }),
  );
}
