/** The table of jobs: only the rows near the visible ones are in the document; the selected one moves by keys. */
import { element, setText } from '../page/dom.js';
import { createRows } from '../panels/rows.js';
import { columnsOf } from './columns.js';
import { hrefOf, OUTCOME_NAME } from './words.js';

/** Browsers draw no element that is higher than some 17 million pixels. */
export const ROWS_MAX = 500000;

const PAGE_ROWS = 12;

function headOf(columns, sort) {
  return element(
    'tr',
    {},
    ...columns.map(({ name, label, title, text }) =>
      element(
        'th',
        { scope: 'col', class: text === undefined ? name : `${name} number`, 'data-column': name },
        title === null
          ? label
          : element('button', { type: 'button', class: 'link', text: label, title, onclick: () => sort(name) }),
      ),
    ),
  );
}

function makeRow(columns, select) {
  const row = element('tr', { class: 'item', role: 'row' });
  for (const { name, text } of columns) {
    const cell = element('td', { class: text === undefined ? name : `${name} number`, role: 'gridcell' });
    if (name === 'outcome') cell.append(element('span', { class: 'outcome' }, element('i'), element('span')));
    if (name === 'name') cell.append(element('a', { tabindex: -1 }));
    row.append(cell);
  }
  row.addEventListener('click', () => select(Number(row.dataset.index)));
  return row;
}

function fillCell(cell, { name, text }, jobs, job) {
  if (name === 'number') setText(cell, String(job + 1));
  else if (name === 'name') {
    const link = cell.firstChild;
    const href = hrefOf(jobs.links[job]);
    setText(link, jobs.names[job]);
    cell.title = jobs.names[job];
    if (href === null) link.removeAttribute('href');
    else link.setAttribute('href', href);
  } else if (name === 'outcome') {
    const outcome = jobs.outcomes[jobs.outcome[job]];
    cell.firstChild.className = `outcome ${outcome}${jobs.found[job] === 1 ? ' found' : ''}`;
    setText(cell.firstChild.lastChild, OUTCOME_NAME[outcome]);
  } else if (name === 'answer') {
    setText(cell, jobs.answers[job]);
    cell.title = jobs.answers[job];
  } else setText(cell, text(job));
}

/**
 * @param {{sort: (column: string) => void, select: (job: number) => void}} actions
 * @returns show(order, selected) lists these jobs; sorted(column, descending) marks the column; reveal(job)
 */
export function createTable(container, jobs, { sort, select }) {
  const columns = columnsOf(jobs);
  const head = headOf(columns, sort);
  const label = 'Jobs';
  const properties = { 'aria-label': label, role: 'grid', tabindex: 0, class: 'jobs' };
  const table = element('table', properties, element('thead', {}, head), element('tbody'));
  const box = element('div', { class: 'scroll' }, table);
  let shown = new Uint32Array(0);
  let selected = null;

  const rows = createRows(box, table, {
    columns: columns.length,
    height: 28,
    printed: 200,
    make: () =>
      makeRow(columns, (index) => {
        select(shown[index]);
        table.focus({ preventScroll: true });
      }),
    fill(row, index) {
      const job = shown[index];
      row.dataset.index = String(index);
      row.id = `job-${job + 1}`;
      row.setAttribute('aria-selected', String(job === selected));
      columns.forEach((column, i) => fillCell(row.cells[i], column, jobs, job));
    },
  });

  function mark(job) {
    selected = job;
    rows.refresh();
    if (job === null) table.removeAttribute('aria-activedescendant');
    else table.setAttribute('aria-activedescendant', `job-${job + 1}`);
  }

  function move(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target !== table || shown.length === 0) return;
    const at = selected === null ? -1 : shown.indexOf(selected);
    const last = Math.min(shown.length, ROWS_MAX) - 1;
    const to = {
      ArrowDown: at + 1,
      ArrowUp: at - 1,
      PageDown: at + PAGE_ROWS,
      PageUp: at - PAGE_ROWS,
      Home: 0,
      End: last,
    }[event.key];
    const link = event.key === 'Enter' && at >= 0 ? hrefOf(jobs.links[selected]) : null;
    if (to === undefined && link === null) return;
    event.preventDefault();
    if (link !== null) window.location.href = link;
    else select(shown[Math.max(0, Math.min(to, last))]);
  }

  table.addEventListener('keydown', move);
  container.append(box);
  return {
    show(order) {
      shown = order;
      rows.toTop();
      rows.show(Math.min(order.length, ROWS_MAX));
    },
    sorted(column, descending) {
      for (const cell of head.cells) {
        if (cell.dataset.column !== column) cell.removeAttribute('aria-sort');
        else cell.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
      }
    },
    select(job) {
      const index = job === null ? -1 : shown.indexOf(job);
      if (index >= 0) rows.reveal(index);
      mark(job);
    },
    first: (column) => columns.find(({ name }) => name === column).first ?? 'descending',
    focus: () => table.focus({ preventScroll: true }),
  };
}
