/** The answer first: a sentence, parts against parts as a matrix, and the events; a click goes to an event's worst frame. */
import { button, element, heading, scrollable, setText } from '../page/dom.js';
import { counted, integer, ranges } from '../page/format.js';
import { isWithin, kindOf, whoOf, worseThan } from '../page/events.js';
import { createRows } from './rows.js';

const PARTS_MOST = 14; // rows of the matrix
const FORWARD = 'M6 2.5v11l7-5.5zM3 2.5h2v11H3z';
const BACK = 'M10 2.5v11L3 8zM11 2.5h2v11h-2z';

function isOrAre(numbers) {
  return numbers.length === 1 ? `Frame ${numbers[0]} has` : `Frames ${ranges(numbers, 4)} have`;
}

/** Why not all was looked at that was asked for; '' if all was. */
function unfinishedOf({ summaries }) {
  const { complete, stopped_by: reason } = summaries[0]?.summary?.summary ?? { complete: true };
  if (complete) return '';
  return `Not finished: ${reason ?? 'no reason is given'}${/\.$/.test(reason ?? '') ? '' : '.'} `;
}

const PARTS_SAID = 5;

/** "in frames 2 to 3, 5". */
function placesOf(spans) {
  const shown = spans.slice(0, 6).map(([first, last]) => (first === last ? `${first}` : `${first} to ${last}`));
  const several = spans.length > 1 || spans[0][0] < spans[0][1];
  return `in frame${several ? 's' : ''} ${shown.join(', ')}${spans.length > 6 ? ' and others' : ''}`;
}

/** Which parts have no surface, and when, as the tool says it. */
function collapsedOf({ summaries }) {
  const parts = summaries[0]?.summary?.collapsed ?? [];
  const said = parts.slice(0, PARTS_SAID).flatMap(({ part, whole, partly }) => [
    ...(whole.length > 0
      ? [` ${part} has no surface ${placesOf(whole)} (all its triangles have no area), and was not looked at there.`] : []),
    ...(partly.length > 0
      ? [` Some pieces of ${part} have no surface ${placesOf(partly)} (all their triangles have no area), and were not looked at there.`]
      : []),
  ]);
  const rest = parts.length - PARTS_SAID;
  if (rest > 0) said.push(` So it is with ${counted(rest, 'other part')}.`);
  return said.join('');
}

/** How many pairs were left out because somebody asked for that, as the tool says it. */
function leftOutOf({ summaries }) {
  const left = summaries[0]?.summary?.left_out ?? {};
  const counts = [
    [left.part_pairs, `of ${left.of_part_pairs} ${left.of_part_pairs === 1 ? 'pair' : 'pairs'} of parts`],
    [left.component_pairs, `${left.component_pairs === 1 ? 'pair' : 'pairs'} of components`],
    [left.triangle_pairs, `${left.triangle_pairs === 1 ? 'pair' : 'pairs'} of triangles`],
  ].filter(([count]) => count > 0);
  if (counts.length === 0) return '';
  const said = counts.map(([count, what]) => `${integer(count)} ${what}`);
  const list = said.length === 1 ? said[0] : `${said.slice(0, -1).join(', ')} and ${said[said.length - 1]}`;
  const one = counts.reduce((sum, [count]) => sum + count, 0) === 1;
  return ` As asked, ${list} ${one ? 'was' : 'were'} not looked at.`;
}

/** The answer in a few sentences, behind what was not looked at, and before what was left out and what had no surface. */
export function sentenceOf(report) {
  const unfinished = unfinishedOf(report);
  return `${unfinished}${findingsOf(report, unfinished !== '')}${leftOutOf(report)}${collapsedOf(report)}`;
}

function findingsOf({ scene }, unfinished) {
  const { answers } = scene;
  if (answers === null) return 'No frame was checked, so this report does not say what intersects.';
  const { crossingFrames, touchingFrames, events } = answers;
  const checked = `${integer(answers.frames_checked)} ${answers.frames_checked === 1 ? 'frame' : 'frames'} checked`;
  const parts = [];
  if (crossingFrames.length > 0) parts.push(`${isOrAre(crossingFrames)} intersections (${crossingFrames.length} of ${checked}).`);
  else if (events.some(isWithin)) parts.push(`No triangles cross, but parts share space (${checked}).`);
  else if (touchingFrames.length > 0) parts.push(`Nothing crosses; ${isOrAre(touchingFrames).toLowerCase()} touching triangles (${checked}).`);
  else parts.push(`Nothing intersects${unfinished ? ' so far' : ''} (${checked}).`);
  const worst = events.reduce((most, event) => (most === null || worseThan(event, most) ? event : most), null);
  if (worst === null) return parts[0];
  parts.push(`${counted(answers.events_found, 'event')}, the worst: ${whoOf(worst)}, ${framesOf(worst)}${depthOf(worst)}.`);
  return parts.join(' ');
}

const framesOf = ({ first, last }) => (first === last ? `frame ${first}` : `frames ${first} to ${last}`);

function depthOf({ depth, deep, worst, pairs }) {
  if (depth > 0) return `, ${deep} deep at frame ${worst}`;
  return pairs > 0 ? `, worst at frame ${worst}` : '';
}

/** Parts that have events, those with the worst first, and the events of each pair. */
function pairsOf(events) {
  const worst = [...events].sort((a, b) => (worseThan(a, b) ? -1 : worseThan(b, a) ? 1 : 0));
  const parts = [...new Set(worst.flatMap(({ a, b }) => [a, b]))];
  const key = (a, b) => JSON.stringify([a, b].sort());
  const cells = new Map();
  for (const event of worst) {
    const found = cells.get(key(event.a, event.b)) ?? [];
    found.push(event);
    cells.set(key(event.a, event.b), found);
  }
  return { parts, of: (a, b) => cells.get(key(a, b)) ?? [] };
}

function matrixCell(events, a, b, deepest, choose) {
  if (events.length === 0) return element('td', { class: 'none' }, element('span', { 'aria-hidden': 'true' }, '·'));
  const { depth, deep } = events[0];
  const title = `${whoOf(events[0])}: ${counted(events.length, 'event')}${depth > 0 ? `, at most ${deep} deep` : ''}`;
  const made = element('button', { type: 'button', class: 'cell', title, 'aria-label': title, 'aria-pressed': 'false' },
    depth > 0 ? deep : integer(events.length));
  made.style.setProperty('--share', String(deepest > 0 ? Math.round(100 * (0.15 + (0.6 * depth) / deepest)) : 15));
  made.addEventListener('click', () => choose(a, b, made));
  return element('td', {}, made);
}

/** Parts against parts: the greatest depth of each pair or, where nothing is buried, how many events it has. */
function matrixOf(events, choose) {
  const { parts, of } = pairsOf(events);
  const shown = parts.slice(0, PARTS_MOST);
  const deepest = events.reduce((most, { depth }) => Math.max(most, depth), 0);
  const head = element('tr', {}, element('th', { scope: 'col' }, element('span', { class: 'visually-hidden' }, 'part')));
  for (const part of shown) head.append(element('th', { scope: 'col', title: part }, element('span', {}, part)));
  const body = element('tbody');
  shown.forEach((a, i) => {
    const row = element('tr', {}, element('th', { scope: 'row', title: a }, a));
    shown.forEach((b, j) => row.append(j > i ? element('td', {}) : matrixCell(of(a, b), a, b, deepest, choose)));
    body.append(row);
  });
  const table = element('table', { class: 'matrix', 'aria-label': 'Parts against parts' }, element('thead', {}, head), body);
  const rest = parts.length - shown.length;
  const more = rest > 0 ? [element('p', { class: 'quiet' }, `${counted(rest, 'more part')} with events, of lesser depth`)] : [];
  return [scrollable(table), ...more];
}

/** @param {boolean} single all events are of one part, so that its name says nothing */
function fillRow(row, event, number, single) {
  if (row.dataset.event === String(number)) return; // what has the focus in it stays
  const [state, word] = kindOf(event);
  const words = single
    ? [word]
    : [element('span', { class: 'visually-hidden' }, `${word}: `), whoOf(event)];
  row.dataset.event = String(number);
  row.replaceChildren(
    element('td', {}, element('button', { type: 'button', 'aria-label': `Event ${number + 1}` }, String(number + 1))),
    element('td', { class: 'who', title: `${whoOf(event)}: ${word}` },
      element('span', { class: `state ${state}` }, element('i'), ...words)),
    element('td', { class: 'number' }, event.first === event.last ? `${event.first}` : `${event.first} to ${event.last}`),
    element('td', { class: 'number', 'data-value': event.depth, title: event.depth }, event.depth > 0 ? event.deep : '–'),
  );
}

function makeRow(go) {
  const row = element('tr', { class: 'item' });
  row.addEventListener('click', () => go(Number(row.dataset.event)));
  return row;
}

const COLUMNS = [['no.'], ['what'], ['frames', true], ['depth', true, 'The greatest depth']];

function createTable() {
  const head = element('tr');
  for (const [text, number, title] of COLUMNS) head.append(element('th', { scope: 'col', text, title, class: number ? 'number' : null }));
  return element('table', { class: 'events', 'aria-label': 'Events' }, element('thead', {}, head), element('tbody'));
}

/** What was left out of the page to keep it small. */
function leftOut(answers) {
  const missing = [];
  const add = (kept, found, what) => {
    if (kept < found) missing.push(`${integer(kept)} of ${integer(found)} ${what}`);
  };
  add(answers.events.length, answers.events_found, 'events, the worst ones');
  add(answers.triangles_kept, answers.triangles_found, 'intersecting triangles');
  add(answers.points_kept, answers.points_found, 'points of curves');
  add(answers.depths_kept, answers.depths_found, 'depths');
  return missing.length > 0 ? [element('p', { class: 'quiet' }, `To keep it small, this page has ${missing.join(', ')}.`)] : [];
}

export function create(container, report, store, player) {
  container.hidden = report.kind !== 'replay';
  if (container.hidden) return;
  const { answers } = report.scene;
  document.getElementById('answer-line').textContent = sentenceOf(report);
  const events = answers?.events ?? [];
  if (events.length === 0) {
    container.hidden = true;
    return;
  }
  const position = element('span', { class: 'quiet', 'aria-live': 'polite' });
  const previous = button('Previous event', { glyph: BACK, key: 'P' }, () => player.stepEvent(-1));
  const next = button('Next event', { glyph: FORWARD, key: 'N' }, () => player.stepEvent(1));
  const names = new Set(events.flatMap(({ a, b }) => [a, b]));
  const single = names.size === 1;
  const table = createTable();
  const list = scrollable(table);
  const all = events.map((_, number) => number);
  let listed = all;
  let chosen = null;
  let current = null;
  const mark = (row) => row.setAttribute('aria-current', String(Number(row.dataset.event) === current));
  const rows = createRows(list, table, {
    columns: COLUMNS.length,
    height: 32,
    printed: 2000,
    make: () => makeRow((number) => player.toEvent(number)),
    fill(row, index) {
      fillRow(row, events[listed[index]], listed[index], single);
      mark(row);
    },
  });
  function choose(a, b, cell) {
    chosen = chosen === cell ? null : cell;
    for (const other of container.querySelectorAll('.matrix .cell')) other.setAttribute('aria-pressed', String(other === chosen));
    listed = all.filter((number) => {
      const event = events[number];
      return chosen === null || (event.a === a && event.b === b) || (event.a === b && event.b === a);
    });
    rows.show(listed.length);
  }
  function show({ event }) {
    setText(position, event === null ? counted(events.length, 'event') : `${event + 1} of ${counted(events.length, 'event')}`);
    current = event;
    for (const row of table.querySelectorAll('tr.item')) mark(row);
    const index = listed.indexOf(event);
    if (index >= 0) rows.reveal(index);
  }
  container.append(
    heading('Events', position, previous, next),
    ...(names.size > 1 ? matrixOf(events, choose) : []),
    list,
    ...leftOut(answers),
  );
  rows.show(listed.length);
  store.on(['event'], show);
  show(store.get());
}
