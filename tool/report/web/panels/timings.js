/** The table of milliseconds per stage, mean and maximum, of every replay in the report. */
import { element, heading, numberCell, scrollable } from '../page/dom.js';
import { decimal, integer, milliseconds } from '../page/format.js';
import { nameOf } from '../page/names.js';
import { lineOf } from './palette.js';
import { hasStage, hasTimes, STAGES } from './stages.js';

const nothing = (text, title) => element('td', { class: 'number absent', text, title });

const milliCell = (column, which) =>
  column ? numberCell(milliseconds(column[which]), column[which]) : nothing('–', 'not in the summary');

function cellsOf(summary, which, first) {
  const cells = STAGES.map(({ key }) =>
    hasStage(summary.method, key)
      ? milliCell(summary[`${key}_ms`], which)
      : nothing('X', 'not part of this method'),
  );
  const pairs = summary.pcp[which];
  cells.push(numberCell(which === 'max' ? integer(pairs) : decimal(pairs, 1), pairs));
  cells.push(milliCell(summary.total_ms, which));
  if (first) {
    const ratio = summary.total_ms?.[which] / first.total_ms?.[which];
    cells.push(
      Number.isFinite(ratio)
        ? numberCell(`${decimal(ratio, 2)} ×`, ratio)
        : nothing('–', 'no time to compare with'),
    );
  }
  cells.push(milliCell(summary.check_ms, which));
  return cells;
}

function methodCell(report, index) {
  const {
    summary: { summary },
  } = report.summaries[index];
  const cell = element('th', { scope: 'rowgroup', rowspan: 2 });
  const several = report.summaries.length > 1;
  if (several) {
    cell.append(lineOf(index), ' ', nameOf(report, index));
    cell.title = nameOf(report, index);
  }
  cell.append(element('span', { class: several ? 'quiet block' : '', text: summary.method }));
  return cell;
}

function rowsOf(report, index, first) {
  const { summary } = report.summaries[index].summary;
  const mean = element(
    'tr',
    {},
    methodCell(report, index),
    element('th', { scope: 'row', text: 'mean' }),
    ...cellsOf(summary, 'mean', first),
  );
  const maximum = element(
    'tr',
    {},
    element('th', { scope: 'row', text: 'maximum' }),
    ...cellsOf(summary, 'max', first),
  );
  return element('tbody', {}, mean, maximum);
}

export function create(container, report) {
  container.hidden = !report.summaries.some(({ summary: { summary } }) => hasTimes(summary));
  if (container.hidden) return;
  const several = report.summaries.length > 1;
  const head = element(
    'tr',
    {},
    element('th', { scope: 'col', text: several ? 'replay, method' : 'method' }),
    element('th', { scope: 'col' }, element('span', { class: 'visually-hidden', text: 'mean or maximum' })),
  );
  const names = [
    ...STAGES.map(({ label }) => label),
    '#PCPs',
    'total',
    ...(several ? ['to the first'] : []),
    'check',
  ];
  for (const text of names) head.append(element('th', { scope: 'col', class: 'number', text }));
  const table = element('table', { 'aria-label': 'Timings' }, element('thead', {}, head));
  const first = several ? report.summaries[0].summary.summary : null;
  report.summaries.forEach((_, index) => table.append(rowsOf(report, index, first)));
  container.append(
    heading('Timings', element('span', { class: 'quiet', text: 'milliseconds per interval, of each stage' })),
    scrollable(table),
    element('p', {
      class: 'quiet',
      text:
        'X: not part of this method. The check of the frame at the end is not part of the total. ' +
        '#PCPs: potentially colliding pairs.',
    }),
  );
}
