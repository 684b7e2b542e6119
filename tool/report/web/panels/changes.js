/** What changed between two runs, event by event: first on the page of a comparison. */
import { element, heading, scrollable, segments } from '../page/dom.js';
import { integer, lengthText } from '../page/format.js';
import { kindOf, whoOf } from '../page/events.js';
import { shortNameOf } from '../page/names.js';
import { matchEvents, worstOf } from '../data/matching.js';

const ROWS_MOST = 500;
const STATES = [
  ['new', 'new'],
  ['still', 'still there'],
  ['fixed', 'fixed'],
  ['unknown', 'not known'],
];
const MEANING = {
  new: 'Only the second run has it.',
  still: 'Both runs have it: the same parts, in the same frames, at the nearest place.',
  fixed: 'Only the first run has it.',
  unknown: 'Only one run has it, and the other one did not check all of its frames.',
};
const CHANGE = { deeper: 'deeper', less: 'less deep', same: '' };

const deepest = (events) => events.reduce((most, { depth }) => Math.max(most, depth), 0);

/** Whether what is still there has become worse; a thousandth is no change. */
function changeOf({ state, before, after }) {
  const [a, b] = [deepest(before), deepest(after)];
  if (state !== 'still' || Math.abs(a - b) <= 1e-3 * Math.max(a, b)) return 'same';
  return b > a ? 'deeper' : 'less';
}

const count = (rows, wanted) => rows.filter(({ state }) => state === wanted).length;

/** "2 events are fixed, 1 is new and 3 are still there (1 deeper)". */
export function sentenceOf(rows) {
  const parts = [];
  for (const [state, words] of [STATES[2], STATES[0], STATES[1], STATES[3]]) {
    const number = count(rows, state);
    if (number === 0 && state === 'unknown') continue;
    const noun = parts.length > 0 ? '' : number === 1 ? ' event' : ' events';
    const many = number > 0 ? integer(number) : parts.length > 0 ? 'none' : 'no';
    parts.push(`${many}${noun} ${number === 1 || many === 'none' ? 'is' : 'are'} ${words}`);
  }
  const worse = rows.filter((row) => changeOf(row) === 'deeper').length;
  if (worse > 0) parts[2] += ` (${integer(worse)} deeper)`;
  return `${parts.slice(0, -1).join(', ')} and ${parts[parts.length - 1]}`;
}

const framesOf = (events) =>
  events.length === 0
    ? '–'
    : [...events]
        .sort((a, b) => a.first - b.first)
        .map(({ first, last }) => (first === last ? `${first}` : `${first} to ${last}`))
        .join(', ');

function depthCell(events, unit) {
  const depth = deepest(events);
  const text = depth > 0 ? lengthText(depth, unit ?? null) : '–';
  return element('td', { class: 'number', text, 'data-value': events.length > 0 ? depth : '', title: depth > 0 ? depth : null });
}

function rowOf(row, [before, after]) {
  const worst = worstOf(row.after.length > 0 ? row.after : row.before);
  const [mark, kind] = kindOf(worst);
  const words = STATES.find(([state]) => state === row.state)[1];
  const change = CHANGE[changeOf(row)];
  const what = element('td', { class: 'who', title: `${whoOf(worst)}: ${kind}` });
  const spoken = element('span', { class: 'visually-hidden' }, `${kind}: `);
  what.append(element('span', { class: `state ${mark}` }, element('i'), spoken, whoOf(worst)));
  const text = change ? `${words}, ${change}` : words;
  return element(
    'tr',
    { 'data-state': row.state },
    element('td', {}, element('span', { class: `change ${row.state}`, title: MEANING[row.state], text })),
    what,
    element('td', { class: 'number', text: framesOf(row.before) }),
    element('td', { class: 'number', text: framesOf(row.after) }),
    depthCell(row.before, before.unit),
    depthCell(row.after, after.unit),
  );
}

function tableOf(rows, runs, names) {
  const head = element('tr');
  for (const text of ['change', 'what']) head.append(element('th', { scope: 'col', text }));
  for (const what of ['frames', 'depth'])
    names.forEach((name) =>
      head.append(
        element('th', { scope: 'col', class: 'number' }, `${what} in `, element('span', { class: 'run', title: name, text: name })),
      ),
    );
  const body = element('tbody', {}, ...rows.slice(0, ROWS_MOST).map((row) => rowOf(row, runs)));
  return element('table', { class: 'changes', 'aria-label': `Events of ${names.join(' and ')}` }, element('thead', {}, head), body);
}

function filterOf(table, rows, id) {
  const options = [['all', `All ${integer(rows.length)}`]];
  for (const [state, words] of STATES) {
    const number = count(rows, state);
    if (number > 0) options.push([state, `${words[0].toUpperCase()}${words.slice(1)} ${integer(number)}`]);
  }
  return segments('Events listed', `change-filter-${id}`, options, 'all', (wanted) => {
    for (const row of table.tBodies[0].rows) row.hidden = wanted !== 'all' && row.dataset.state !== wanted;
  });
}

const missing = (name) =>
  element('p', { class: 'note warn' }, element('strong', { text: `${name} has no list of events. ` }),
    'An older version of cscd wrote it. To compare events, replay the recording again and write a new summary.');

/** The block of one run against the first. */
function blockOf(report, index, container) {
  const names = [shortNameOf(report, 0), shortNameOf(report, index)];
  const runs = [report.summaries[0].summary, report.summaries[index].summary];
  const rows = matchEvents(...runs);
  const sentence = rows.length === 0
    ? `Neither ${names[0]} nor ${names[1]} has an event: nothing meets or intersects.`
    : `From ${names[0]} to ${names[1]}, ${sentenceOf(rows)}.`;
  container.append(element('p', { class: 'change-sentence', text: sentence }));
  if (rows.length === 0) return;
  // Of many runs the sentences are the answer; the tables are there to look things up.
  const box = report.summaries.length === 2 ? container : element('details', {}, element('summary', { text: 'Events' }));
  if (box !== container) container.append(box);
  const table = tableOf(rows, runs, names);
  box.append(heading('Events', filterOf(table, rows, index)), scrollable(table));
  if (rows.length > ROWS_MOST) {
    const text = `The first ${integer(ROWS_MOST)} of ${integer(rows.length)} rows are listed.`;
    box.append(element('p', { class: 'quiet', text }));
  }
  if (runs[0].unit !== runs[1].unit) {
    const text = 'The two runs give lengths in different units, so depths and places cannot be compared.';
    container.append(element('p', { class: 'note warn', text }));
  }
}

export function create(container, report) {
  container.hidden = report.kind !== 'compare' || report.summaries.length < 2;
  if (container.hidden) return;
  const old = report.summaries.map((_, i) => i).filter((i) => report.summaries[i].summary.events === undefined);
  container.append(...old.map((i) => missing(shortNameOf(report, i))));
  if (old.includes(0)) return;
  report.summaries.forEach((_, i) => {
    if (i > 0 && !old.includes(i)) blockOf(report, i, container);
  });
}
