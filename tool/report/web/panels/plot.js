/** A chart over the intervals, of stacked areas or lines. It is drawn once; a line on top is the current moment. */
import uPlot from 'uplot';
import { columnsOf, heaviest } from '../page/columns.js';
import { element } from '../page/dom.js';

export const LEFT = 52;
export const RIGHT = 12;

const AXIS_FONT = '11px system-ui, sans-serif';

const token = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** A colour, or the name of one of the page's colours. */
const colourOf = (colour) => (colour.startsWith('--') ? token(colour) : colour);

/** The value that 98 % of the intervals stay below, so that a few peaks do not flatten the rest. */
function usualLimit({ numbers, series, stacked }) {
  const heights = new Float64Array(numbers.length - 1);
  for (const { values } of series) {
    for (let i = 0; i < heights.length; i++) {
      const value = values[i] ?? 0;
      heights[i] = stacked ? heights[i] + value : Math.max(heights[i], value);
    }
  }
  heights.sort();
  return heights[Math.floor(0.98 * (heights.length - 1))] * 1.2;
}

/**
 * Steps: the value of interval k holds from place k to k + 1, so the last is given twice. Of the intervals that share a
 * pixel the one with the most shows.
 */
function stepsOf({ series, stacked }, from, to, pixels) {
  const columns = columnsOf(from, to, pixels);
  const x = [...columns.map(({ begin }) => begin), to];
  const kept = (weight) => columns.map(({ begin, end }) => heaviest(begin, end, weight));
  const at = (values, places) => {
    const column = places.map((i) => values[i]);
    column.push(column[column.length - 1]);
    return column;
  };
  if (!stacked) return [x, ...series.map(({ values }) => at(values, kept((i) => values[i] ?? -1)))];
  const places = kept((i) => {
    let sum = 0;
    for (const { values } of series) sum += values[i];
    return sum;
  });
  const sums = new Float64Array(places.length + 1);
  const areas = series.map(({ values }) => at(values, places).map((value, i) => (sums[i] += value)));
  return [x, ...areas.reverse()];
}

function seriesOptions({ series, stacked }) {
  const steps = uPlot.paths.stepped({ align: 1 });
  const options = series.map(({ label, colour, dash }) => ({
    label,
    paths: steps,
    points: { show: false },
    width: stacked ? 0 : 1.75,
    dash,
    stroke: () => colourOf(colour),
    fill: stacked ? () => colourOf(colour) : undefined,
  }));
  return [{}, ...(stacked ? options.reverse() : options)];
}

/** Leaves out a number at the right end, which would be cut off. */
function frameLabels(numbers, { scales: { x } }, splits) {
  const room = (x.max - x.min) * 0.015;
  return splits.map((place) => {
    const label = String(numbers[place] ?? '');
    return label.length < 4 || place < x.max - room ? label : '';
  });
}

/** Places with a label: those of round numbers where frames count by ones, else round places. */
function roundPlaces(numbers, least, most, increment) {
  const byOnes = numbers[numbers.length - 1] - numbers[0] === numbers.length - 1;
  const offset = byOnes ? ((-numbers[0] % increment) + increment) % increment : 0;
  const splits = [];
  const from = offset + increment * Math.ceil((least - offset) / increment);
  for (let place = from; place <= most; place += increment) splits.push(place);
  return splits;
}

function axes({ format, numbers }, logarithmic) {
  const common = { font: AXIS_FONT, stroke: () => token('--quiet'), ticks: { show: false } };
  return [
    {
      ...common,
      size: 22,
      gap: 3,
      space: 56,
      incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000],
      grid: { show: false },
      splits: (_, axis, least, most, increment) => roundPlaces(numbers, least, most, increment),
      values: (chart, splits) => frameLabels(numbers, chart, splits),
    },
    {
      ...common,
      size: LEFT,
      gap: 5,
      space: logarithmic ? 18 : 26,
      grid: { stroke: () => token('--grid'), width: 1 },
      values: (_, splits) => splits.map((value) => (value === null ? '' : format(value))),
    },
  ];
}

/**
 * @param {HTMLElement} host
 * @param {{numbers: ArrayLike<number>, height: number, stacked: boolean, format: (value: number) => string,
 *          series: {label: string, colour: string, dash?: number[], values: ArrayLike<number|null>}[]}} plot
 *   numbers: of all frames; values: of each interval
 * @param {(surface: HTMLElement) => void} attach is called with the layer over the plot, each time the plot is made
 */
export function createPlot(host, plot, attach) {
  const { numbers, height } = plot;
  const timeLine = element('div', { class: 'time-line' });
  const hoverLine = element('div', { class: 'hover-line', hidden: true });
  let range = [0, numbers.length - 1];
  let logarithmic = false;
  let cut = false;
  let usual = null; // until it is asked for
  let chart = null;
  let time = 0;
  let hover = null;

  const width = () => Math.max(160, host.clientWidth);
  const data = () => stepsOf(plot, range[0], range[1], Math.floor((width() - LEFT - RIGHT) * 1.5));

  /** The labels of the scale when the highest value shown is `high`. */
  function topOf(high) {
    if (cut) usual ??= usualLimit(plot);
    const top = cut && usual > 0 ? Math.min(high, usual) : high;
    return top > 0 ? top * 1.04 : 1;
  }

  function build() {
    chart?.destroy();
    const options = {
      width: width(),
      height,
      padding: [6, RIGHT, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      select: { show: false },
      scales: {
        x: { time: false, range: () => [range[0], range[1]] },
        y: logarithmic ? { distr: 3 } : { range: (_, low, high) => [0, topOf(high)] },
      },
      axes: axes(plot, logarithmic),
      series: seriesOptions(plot),
      hooks: { ready: [moveLines], setScale: [moveLines] },
    };
    chart = new uPlot(options, data(), host);
    chart.ctx.canvas.setAttribute('aria-hidden', 'true'); // the figure has a label and its numbers
    chart.over.append(hoverLine, timeLine);
    attach(chart.over);
  }

  function moveLine(line, at) {
    const inside = chart.status === 1 && at !== null && at >= range[0] && at <= range[1];
    line.hidden = !inside;
    if (inside) line.style.transform = `translateX(${chart.valToPos(at, 'x')}px)`;
  }

  function moveLines() {
    moveLine(timeLine, time);
    moveLine(hoverLine, hover);
  }

  build();
  return {
    /** A place: intervals from the first, with a fraction. */
    setTime(at) {
      time = at;
      moveLine(timeLine, time);
    },
    /** The place that the pointer is on, or null. */
    setHover(interval) {
      hover = interval;
      moveLine(hoverLine, hover);
    },
    /** Shows the intervals from begin to end, counted from the first. */
    setRange(begin, end) {
      range = [begin, end];
      chart.setData(data());
    },
    setScale(scale) {
      ({ logarithmic, cut } = scale);
      build();
    },
    resize() {
      if (chart.width === width()) return;
      chart.setSize({ width: width(), height });
      chart.setData(data());
    },
    /** After a change of theme. */
    recolour: () => chart.redraw(false, true),
  };
}
