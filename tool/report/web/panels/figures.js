/** The charts and their numbers. */
import { counted, decimal, integer, milliseconds, significant } from '../page/format.js';
import { nameOf } from '../page/names.js';
import { lineOf, lineStyle } from './palette.js';
import { hasTimes, OTHER, otherMilliseconds, stagesOf } from './stages.js';

/** A value of each interval; null where the replay has none. */
const column = (numbers, find, value) =>
  Array.from({ length: numbers.length - 1 }, (_, i) => {
    const interval = find(numbers[i]);
    return interval ? value(interval) : null;
  });

function largest(values) {
  let at = 0;
  for (let i = 1; i < values.length; i++) if ((values[i] ?? -1) > (values[at] ?? -1)) at = i;
  return at;
}

const millisecondsWithUnit = (value) => `${milliseconds(value)} ms`;

const tick = (value) => (value >= 10000 ? `${significant(value / 1000, 4)}k` : significant(value, 6));

function stageFigure({ summary: { summary } }, numbers, find) {
  const total = column(numbers, find, ({ ms }) => ms.total);
  const stages = stagesOf(summary.method).map((stage) => ({
    ...stage,
    values: column(numbers, find, ({ ms }) => ms[stage.key]),
  }));
  const other = { ...OTHER, values: column(numbers, find, ({ ms }) => otherMilliseconds(ms)) };
  const { mean, max } = summary.total_ms;
  const most = numbers[largest(total)];
  const words = `mean ${milliseconds(mean)} ms, maximum ${milliseconds(max)} ms (frame ${most})`;
  return {
    title: 'Milliseconds per stage',
    summary: words,
    stacked: true,
    height: 132,
    read: millisecondsWithUnit,
    format: tick,
    series: [...stages, other],
    total,
  };
}

function contactFigure({ summary: { summary } }, numbers, find) {
  const vf = column(numbers, find, (interval) => interval.vf);
  const ee = column(numbers, find, (interval) => interval.ee);
  const both = vf.map((value, i) => (value === null ? null : value + ee[i]));
  const most = largest(both);
  const words =
    summary.vf + summary.ee === 0
      ? 'none'
      : `${integer(summary.vf)} VF and ${integer(summary.ee)} EE ` +
        `in ${counted(summary.intervals_with_contact, 'interval')}, ` +
        `at most ${integer(both[most])} (frame ${numbers[most]})`;
  return {
    title: 'Contacts per interval',
    summary: words,
    stacked: true,
    height: 112,
    read: integer,
    format: tick,
    series: [
      { label: 'VF', colour: '--vf-area', values: vf },
      { label: 'EE', colour: '--ee-area', values: ee },
    ],
    total: both,
  };
}

function pairFigure({ summary: { summary } }, numbers, find) {
  const values = column(numbers, find, ({ pcp }) => pcp);
  const { mean, max } = summary.pcp;
  const words = `mean ${decimal(mean, 1)}, maximum ${integer(max)} (frame ${numbers[largest(values)]})`;
  return {
    title: 'Pairs per interval (#PCPs)',
    summary: words,
    stacked: true,
    height: 112,
    read: integer,
    format: tick,
    series: [{ label: 'triangle pairs whose volumes overlap', colour: '#009e73', values }],
  };
}

/** The charts of one replay. If it was stopped, missing values count as 0 in a stack. */
export function replayFigures(report, numbers, [find]) {
  const timed = hasTimes(report.summaries[0].summary.summary);
  return [...(timed ? [stageFigure] : []), contactFigure, pairFigure].map((make) =>
    make(report.summaries[0], numbers, find),
  );
}

function compareFigure(report, numbers, finders, { title, value, read, words }) {
  const series = report.summaries.map((_, index) => ({
    ...lineStyle(index),
    label: nameOf(report, index),
    mark: lineOf(index),
    summary: words(report.summaries[index].summary.summary),
    values: column(numbers, finders[index], value),
  }));
  return { title, summary: '', stacked: false, height: 190, read, format: tick, series };
}

/** The charts of several replays, a line for each. */
export function compareFigures(report, numbers, finders) {
  const timed = report.summaries.every(({ summary: { summary } }) => hasTimes(summary));
  return [
    timed && {
      title: 'Milliseconds per interval',
      value: ({ ms }) => ms.total,
      read: millisecondsWithUnit,
      words: ({ total_ms: total }) =>
        `mean ${milliseconds(total.mean)}, maximum ${milliseconds(total.max)} ms`,
    },
    {
      title: 'Contacts per interval',
      value: ({ vf, ee }) => vf + ee,
      read: integer,
      words: ({ vf, ee }) => `${integer(vf + ee)} in all`,
    },
    {
      title: 'Pairs per interval (#PCPs)',
      value: ({ pcp }) => pcp,
      read: integer,
      words: ({ pcp }) => `mean ${decimal(pcp.mean, 1)}, maximum ${integer(pcp.max)}`,
    },
  ]
    .filter(Boolean)
    .map((figure) => compareFigure(report, numbers, finders, figure));
}
