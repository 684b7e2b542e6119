/** The table that compares several replays. */
import { agreement, differences } from './agreement.js';
import { element, heading, numberCell, scrollable } from '../page/dom.js';
import { counted, decimal, integer } from '../page/format.js';
import { nameOf } from '../page/names.js';
import { lineOf } from './palette.js';
import { hasTimes } from './stages.js';

const note = ([grade, text]) => element('p', { class: `note ${grade}`, text });

function overview(report) {
  const head = element('tr');
  const names = ['replay', 'method', 'intervals', 'with contact', 'VF', 'EE', 'mean total', 'to the first'];
  names.forEach((text, i) =>
    head.append(element('th', { scope: 'col', text, class: i > 1 ? 'number' : undefined })),
  );
  const body = element('tbody');
  const base = report.summaries[0].summary.summary.total_ms?.mean;
  report.summaries.forEach(({ summary: { summary } }, index) => {
    const ratio = summary.total_ms?.mean / base;
    body.append(
      element(
        'tr',
        {},
        element('th', { scope: 'row' }, lineOf(index), ` ${nameOf(report, index)}`),
        element('td', { text: summary.method }),
        ...['intervals', 'intervals_with_contact', 'vf', 'ee'].map((key) =>
          numberCell(integer(summary[key]), summary[key]),
        ),
        hasTimes(summary)
          ? numberCell(`${decimal(summary.total_ms.mean, 3)} ms`, summary.total_ms.mean)
          : numberCell('–', ''),
        Number.isFinite(ratio) ? numberCell(`${decimal(ratio, 2)} ×`, ratio) : numberCell('–', ''),
      ),
    );
  });
  return scrollable(element('table', { 'aria-label': 'Comparison' }, element('thead', {}, head), body));
}

export function create(container, report) {
  container.hidden = report.kind !== 'compare' || report.summaries.length === 0;
  if (container.hidden) return;
  const words = [...differences(report), ...agreement(report)];
  container.append(
    heading(
      'Comparison',
      element('span', { class: 'quiet', text: counted(report.summaries.length, 'replay') }),
    ),
    overview(report),
  );
  if (words.length > 0) container.append(element('div', { class: 'comparison-notes' }, ...words.map(note)));
}
