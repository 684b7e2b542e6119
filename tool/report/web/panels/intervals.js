/** All intervals in one table; a click on a row goes to its interval. */
import { onCalmly } from '../controls/calm.js';
import { element, heading, segments, setText } from '../page/dom.js';
import { counted, decimal, integer, milliseconds } from '../page/format.js';
import { extentOf, intervalAt } from '../page/intervals.js';
import { STATE_MEANING, STATE_NAME } from '../page/states.js';
import { createRows } from './rows.js';
import { guaranteeInWords } from './stages.js';

const COLUMNS = [
  ['frame', 'The interval goes from this frame to the next'],
  ['state', 'Whether the mesh intersects itself at the start, and whether there is contact'],
  ['VF', 'Contacts of a vertex and a face', true],
  ['EE', 'Contacts of two edges', true],
  ['earliest toi', 'Time of impact of the first contact, 0 to 1 within the interval', true],
  ['#PCPs', 'Potentially colliding pairs: triangle pairs whose volumes overlap', true],
  ['tests', 'Elementary tests of a vertex and a face or of two edges', true],
  ['ms', 'Milliseconds of the whole step; the check of the frame is not part of it', true],
  ['may contacts be missing?', 'Whether every contact of the interval was found, and why that is known'],
];

const FILTERS = {
  all: () => true,
  contacts: ({ vf, ee }) => vf + ee > 0,
  penetrating: ({ state }) => state === 'penetrating',
};

function createTable() {
  const head = element('tr');
  for (const [text, title, number] of COLUMNS)
    head.append(element('th', { scope: 'col', text, title, class: number ? 'number' : undefined }));
  return element('table', { 'aria-label': 'Intervals' }, element('thead', {}, head), element('tbody'));
}

function makeRow(go) {
  const row = element('tr', { class: 'item' }, element('td', {}, element('button', { type: 'button' })));
  row.append(element('td', {}, element('span', { class: 'state' }, element('i'), element('span'))));
  for (let i = 2; i < 8; i++) row.append(element('td', { class: 'number' }));
  row.append(element('td', { class: 'words' }));
  row.addEventListener('click', () => go(Number(row.dataset.frame)));
  return row;
}

function setNumber(cell, value, text) {
  setText(cell, text);
  cell.dataset.value = String(value);
  cell.title = String(value);
}

function fillRow(row, interval) {
  const [frame, state, vf, ee, toi, pcp, tests, ms, words] = row.cells;
  row.dataset.frame = String(interval.frame);
  setText(frame.firstChild, String(interval.frame));
  frame.firstChild.setAttribute('aria-label', `Frame ${interval.frame}`);
  state.firstChild.className = `state ${interval.state}`;
  state.firstChild.title = STATE_MEANING[interval.state] ?? '';
  setText(state.firstChild.lastChild, STATE_NAME[interval.state] ?? interval.state);
  setNumber(vf, interval.vf, integer(interval.vf));
  setNumber(ee, interval.ee, integer(interval.ee));
  setNumber(
    toi,
    interval.earliest_toi,
    interval.earliest_toi === null ? '–' : decimal(interval.earliest_toi, 6),
  );
  setNumber(pcp, interval.pcp, integer(interval.pcp));
  setNumber(tests, interval.tests, integer(interval.tests));
  setNumber(ms, interval.ms?.total ?? null, interval.ms ? milliseconds(interval.ms.total) : '–');
  setText(words, guaranteeInWords(interval.guarantee));
  words.title = words.textContent;
}

export function create(container, report, store, player) {
  const intervals = report.kind === 'replay' ? (report.summaries[0]?.summary.intervals ?? []) : [];
  container.hidden = intervals.length === 0;
  if (container.hidden) return;
  const extent = extentOf(report);
  const table = createTable();
  const scroll = element('div', { class: 'scroll' }, table);
  const count = element('span', { class: 'quiet' });
  let shown = intervals;
  let current = -1;

  const rows = createRows(scroll, table, {
    columns: COLUMNS.length,
    height: 32,
    printed: 2000,
    make: () => makeRow((frame) => player.stepTo(frame)),
    fill(row, index) {
      fillRow(row, shown[index]);
      row.setAttribute('aria-current', String(shown[index].frame === current));
    },
  });

  function list(filter) {
    shown = intervals.filter(FILTERS[filter]);
    setText(
      count,
      shown.length === intervals.length
        ? counted(intervals.length, 'interval')
        : `${integer(shown.length)} of ${counted(intervals.length, 'interval')}`,
    );
    rows.toTop();
    rows.show(shown.length);
  }

  /** The row of the current interval is marked, and while nothing plays it is scrolled to. */
  function follow({ time, playing }) {
    const interval = intervalAt(time, extent);
    if (interval === current && playing) return;
    const moved = interval !== current;
    current = interval;
    for (const row of table.querySelectorAll('tr.item'))
      row.setAttribute('aria-current', String(Number(row.dataset.frame) === current));
    if (playing || !moved || scroll.contains(document.activeElement)) return;
    const index = shown.findIndex(({ frame }) => frame === current);
    if (index >= 0) rows.reveal(index);
  }

  container.append(
    heading(
      'Intervals',
      count,
      segments(
        'Intervals listed',
        'interval-filter',
        [
          ['all', 'All intervals'],
          ['contacts', 'With contacts'],
          ['penetrating', 'Intersecting'],
        ],
        'all',
        list,
      ),
    ),
    scroll,
  );
  list('all');
  onCalmly(store, ['time'], follow);
  follow({ ...store.get(), playing: false });
}
