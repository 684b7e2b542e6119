/** What has become of each frame that was untangled, and what is left in the frame at hand. */
import { onCalmly } from '../controls/calm.js';
import { element, heading, numberCell, scrollable } from '../page/dom.js';
import { counted, integer, lengthText } from '../page/format.js';
import { lastAtOrBefore } from '../page/intervals.js';
import { createRows } from './rows.js';

const WHY = {
  no_way: 'no way out of each other was found',
  flush: 'they lie on each other, and no way out was found',
  time: 'the time was up',
  stopped: 'interrupted',
  immobile: 'neither may move',
};
const COLUMNS = [['frame'], ['before', 'Pairs of triangles that crossed or touched'], ['after', 'Those that are left'],
  ['moved', 'Vertices that moved'], ['at most', 'How far the farthest moved']];

const withNone = (part) => part ?? 'rest';

function leftTable(left) {
  const head = element('tr', {}, element('th', { scope: 'col' }, 'parts'), element('th', { scope: 'col', class: 'number' }, 'pairs'),
    element('th', { scope: 'col' }, 'why'));
  const body = element('tbody');
  for (const { part_a: a, part_b: b, pairs, reason } of left) {
    body.append(element('tr', {}, element('td', {}, a === b ? `${withNone(a)} × itself` : `${withNone(a)} × ${withNone(b)}`),
      numberCell(integer(pairs), pairs), element('td', {}, WHY[reason] ?? reason)));
  }
  return element('table', { 'aria-label': 'What is left' }, element('thead', {}, head), body);
}

function framesTable() {
  const head = element('tr');
  for (const [text, title] of COLUMNS) head.append(element('th', { scope: 'col', class: 'number', text, title }));
  return element('table', { class: 'events', 'aria-label': 'Frames' }, element('thead', {}, head), element('tbody'));
}

function fillRow(row, one, unit) {
  row.dataset.frame = String(one.frame);
  row.replaceChildren(
    element('td', { class: 'number' }, element('button', { type: 'button', 'aria-label': `Frame ${one.frame}` }, String(one.frame))),
    numberCell(integer(one.pairs_before), one.pairs_before),
    numberCell(integer(one.pairs_after), one.pairs_after),
    numberCell(integer(one.moved_vertices), one.moved_vertices),
    numberCell(one.moved_vertices > 0 ? lengthText(one.displacement, unit) : '–', one.displacement),
  );
}

function createFrames(container, frames, unit, store, player) {
  const table = framesTable();
  const list = scrollable(table);
  let current = null;
  const mark = (row) => row.setAttribute('aria-current', String(Number(row.dataset.frame) === current));
  const rows = createRows(list, table, {
    columns: COLUMNS.length,
    height: 32,
    printed: 2000,
    make() {
      const row = element('tr', { class: 'item' });
      row.addEventListener('click', () => player.stepTo(Number(row.dataset.frame)));
      return row;
    },
    fill(row, index) {
      fillRow(row, frames[index], unit);
      mark(row);
    },
  });
  container.append(heading('Frames', element('span', { class: 'quiet' }, counted(frames.length, 'frame'))), list);
  rows.show(frames.length);
  return (index) => {
    if (frames[index].frame === current) return;
    current = frames[index].frame;
    for (const row of table.querySelectorAll('tr.item')) mark(row);
    rows.reveal(index);
  };
}

export function create(container, report, store, player) {
  const { untangled, scene } = report;
  container.hidden = untangled === null;
  if (container.hidden) return;
  document.getElementById('answer-line').textContent = untangled.answer ?? '';
  const { frames } = untangled;
  const numbers = frames.map(({ frame }) => frame);
  const follow = frames.length > 1 ? createFrames(container, frames, scene.lengthUnit, store, player) : () => {};
  const left = element('div', { class: 'left-pairs' });
  if (frames.some((one) => (one.left ?? []).length > 0)) container.append(left);
  const show = ({ time }) => {
    const index = Math.max(0, lastAtOrBefore(numbers, time));
    const found = frames[index].left ?? [];
    follow(index);
    left.replaceChildren(...(found.length > 0 ? [heading('What is left'), scrollable(leftTable(found))] : []));
  };
  container.hidden = container.childElementCount === 0;
  onCalmly(store, ['time'], show);
  show(store.get());
}
