/** The contacts of the current interval: which features touch, when and where. */
import { onCalmly } from '../controls/calm.js';
import { element, heading, segments, setText } from '../page/dom.js';
import { coordinates, counted, decimal, integer, positionDecimals } from '../page/format.js';
import { extentOf, finder, intervalAt } from '../page/intervals.js';
import { createRows } from './rows.js';

const KINDS = ['VF', 'EE'];
const LISTED_UP_TO = 5; /* frames a second; faster, a list cannot be read and costs as much as the view */

function featureWords(contacts, contact) {
  const numbers = contacts.fileVertices ?? contacts.vertices;
  const [a, b, c, d] = numbers.subarray(4 * contact, 4 * contact + 4);
  return contacts.kind[contact] === 0
    ? `vertex ${a} · face ${b} ${c} ${d}`
    : `edge ${a} ${b} · edge ${c} ${d}`;
}

/** Whether a row needs a second line for its features. */
function hasLongNumbers({ vertices, fileVertices }) {
  return (fileVertices ?? vertices).some((vertex) => vertex > 9999);
}

function createTable() {
  const toi = element('button', {
    type: 'button',
    class: 'link',
    text: 'toi',
    title: 'Time of impact within the interval, 0 to 1',
  });
  const head = element(
    'tr',
    {},
    element('th', { scope: 'col', text: 'no.' }),
    element('th', { scope: 'col', text: 'kind' }),
    element('th', { scope: 'col', text: 'features' }),
    element('th', { scope: 'col' }, toi),
    element('th', { scope: 'col', text: 'position x, y, z' }),
  );
  const table = element(
    'table',
    { 'aria-label': 'Contacts of this interval' },
    element('thead', {}, head),
    element('tbody'),
  );
  return { table, toi };
}

function makeRow(select) {
  const button = element('button', { type: 'button' });
  const kind = element('td', {}, element('span'), element('span'));
  const row = element(
    'tr',
    { class: 'item' },
    element('td', {}, button),
    kind,
    element('td'),
    element('td'),
    element('td'),
  );
  row.addEventListener('click', () => select(Number(row.dataset.contact)));
  return row;
}

function fillRow(row, { contacts, unit, decimals }, contact, number) {
  const [first, kind, features, toi, position] = row.cells;
  const button = first.firstChild;
  row.dataset.contact = String(contact);
  setText(button, String(number));
  button.setAttribute('aria-label', `Contact ${number}`);
  kind.firstChild.className = contacts.kind[contact] === 0 ? 'mark-vf' : 'mark-ee';
  setText(kind.lastChild, KINDS[contacts.kind[contact]]);
  setText(features, featureWords(contacts, contact));
  features.title = features.textContent;
  setText(toi, decimal(contacts.toi[contact], 6));
  toi.title = toi.dataset.value = String(contacts.toi[contact]);
  const point = [...contacts.point.subarray(3 * contact, 3 * contact + 3)].map((value) => value * unit);
  setText(position, coordinates(point, decimals));
  position.title = position.dataset.value = point.join(' ');
}

/** The contacts from begin to end that the reader has chosen, in the chosen order. */
function choose(contacts, [begin, end], { kind, descending }) {
  const chosen = [];
  for (let contact = begin; contact < end; contact++) {
    if (kind === 'all' || contacts.kind[contact] === (kind === 'vf' ? 0 : 1)) chosen.push(contact);
  }
  chosen.sort((a, b) => contacts.toi[a] - contacts.toi[b] || a - b);
  return descending ? chosen.reverse() : chosen;
}

/** The sentence in place of the list when the interval has no contact. */
function createEmpty(player) {
  const text = element('p');
  const next = element('button', {
    type: 'button',
    text: 'Go to the next with contacts',
    onclick: () => player.nextWithContacts(),
  });
  const previous = element('button', {
    type: 'button',
    text: 'Go to the previous with contacts',
    onclick: () => player.previousWithContacts(),
  });
  const box = element('div', { class: 'empty' }, text, next, previous);
  return {
    box,
    say(words, before, after) {
      setText(text, words);
      previous.hidden = !before;
      next.hidden = !after;
    },
  };
}

function createCounts() {
  const vf = element('span');
  const ee = element('span');
  const box = element(
    'span',
    { class: 'counts' },
    element('span', {}, element('span', { class: 'mark-vf' }), vf),
    element('span', {}, element('span', { class: 'mark-ee' }), ee),
  );
  return {
    box,
    say(interval) {
      setText(vf, `${integer(interval?.vf ?? 0)} VF`);
      setText(ee, `${integer(interval?.ee ?? 0)} EE`);
    },
  };
}

export function create(container, report, store, player) {
  const contacts = report.scene?.contacts;
  if (report.kind !== 'replay' || !contacts) return;
  const extent = extentOf(report);
  const find = finder(report.summaries[0]?.summary);
  const order = { kind: 'all', descending: false };
  const { unit } = report.scene;
  const data = { contacts, unit, decimals: positionDecimals(contacts.point, unit) };
  const counts = createCounts();
  container.classList.toggle('long-numbers', hasLongNumbers(contacts));
  const { table, toi } = createTable();
  const scroll = element('div', { class: 'scroll' }, table);
  const empty = createEmpty(player);
  const capped = element('p', { class: 'quiet' });
  const { found: all } = report.scene.contactsInfo;
  const nothingHere = all === 0 ? 'No contact in this whole recording.' : 'No contact in this interval.';
  let shown = [];
  let begin = 0;
  let current = -1;
  let listed = -1;

  const select = (contact) => player.select(contact);
  const rows = createRows(scroll, table, {
    columns: 5,
    height: 48,
    printed: 50,
    make: () => makeRow(select),
    fill(row, index) {
      const contact = shown[index];
      fillRow(row, data, contact, contact - begin + 1);
      row.setAttribute('aria-current', String(store.get().selected === contact));
    },
  });

  function sayWhatIsMissing(kept, interval) {
    const found = interval ? interval.vf + interval.ee : kept;
    capped.hidden = kept >= found;
    setText(capped, `Only the first ${integer(kept)} of ${counted(found, 'contact')} are in this report.`);
    const before = contacts.count > 0 && contacts.interval[0] < current;
    const after = contacts.count > 0 && contacts.interval[contacts.count - 1] > current;
    const none = found > 0 ? 'The contacts of this interval are not in this report.' : nothingHere;
    empty.say(
      shown.length === 0 && kept > 0 ? 'No contact of this kind in this interval.' : none,
      before,
      after,
    );
  }

  function list() {
    listed = current;
    const range = contacts.range(current);
    begin = range[0];
    shown = choose(contacts, range, order);
    sayWhatIsMissing(range[1] - begin, find(current));
    scroll.hidden = shown.length === 0;
    empty.box.hidden = shown.length > 0;
    rows.toTop();
    rows.show(shown.length);
  }

  /** Shows only the counts while the recording plays fast. */
  function rest() {
    listed = -1;
    capped.hidden = scroll.hidden = true;
    empty.box.hidden = false;
    empty.say('Listed when the playback pauses.', false, false);
  }

  function update({ time, playing, speed }) {
    current = intervalAt(time, extent);
    counts.say(find(current));
    if (playing && speed > LISTED_UP_TO) rest();
    else if (listed !== current) list();
  }

  function follow({ selected }) {
    const index = shown.indexOf(selected);
    if (index >= 0) rows.reveal(index);
    rows.refresh();
  }

  toi.addEventListener('click', () => {
    order.descending = !order.descending;
    toi.closest('th').setAttribute('aria-sort', order.descending ? 'descending' : 'ascending');
    list();
  });
  toi.closest('th').setAttribute('aria-sort', 'ascending');
  const filter = segments(
    'Kinds listed',
    'contact-kind',
    [
      ['all', 'All kinds'],
      ['vf', 'VF only'],
      ['ee', 'EE only'],
    ],
    'all',
    (kind) => {
      order.kind = kind;
      list();
    },
  );
  container.append(
    heading('Contacts of this interval', counts.box),
    element('div', { class: 'section-head' }, filter),
    capped,
    empty.box,
    scroll,
  );
  onCalmly(store, ['time'], update);
  store.on(['selected'], follow);
  update(store.get());
}
