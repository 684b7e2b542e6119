/** Opens the page of many jobs: reads its columns, then builds the answer, the choices and the table. */
import { createStore } from '../controls/store.js';
import { followTheme, initialTheme } from '../controls/theme.js';
import { button, element } from '../page/dom.js';
import { counted } from '../page/format.js';
import { create as createLicences } from '../panels/licences.js';
import { createChoices } from './choices.js';
import { countOutcomes, createFilter, createOrders, readJobs } from './data.js';
import { createDetails } from './details.js';
import { createTable } from './table.js';
import { answerOf } from './words.js';

const SUN =
  'M8 4.5a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7zM7.3 0h1.4v3H7.3zM7.3 13h1.4v3H7.3zM0 7.3h3v1.4H0zM13 7.3' +
  'h3v1.4h-3z';

const byId = (id) => document.getElementById(id);

function showError(error) {
  console.error(error);
  byId('opening')?.remove();
  if (window.cscd.jobs === undefined) byId('main').hidden = true;
  const message = element('div', { role: 'alert', class: 'failure' });
  message.append(element('strong', {}, 'This report cannot be shown in full.'), ' ', String(error?.message ?? error));
  document.body.prepend(message);
}

/** What a reader must know before the rest. */
function addNotes(container, jobs, counts) {
  if (counts.missing > 0)
    container.append(
      element(
        'p',
        { class: 'note warn' },
        element('strong', {
          text: `${counted(counts.missing, 'job')} ${counts.missing === 1 ? 'is' : 'are'} not done: ${jobs.missing}. `,
        }),
        'Their shard is still running, has died, or is not among these results. --resume goes on with a shard; then make this page again.',
      ),
    );
  if (counts.found > 0)
    container.append(
      element('p', {
        class: 'note',
        text: `${counted(counts.found, 'job')} found what --fail-on, --fail-depth or --max-faces of the run asks for.`,
      }),
    );
}

function follow(store, jobs, table, choices) {
  const orderOf = createOrders(jobs);
  const filter = createFilter(jobs);
  let order = null;

  const list = ({ kind, text }) => {
    const shown = filter(order, kind, text);
    table.show(shown);
    choices.say(shown.length);
  };
  const sort = (state) => {
    order = orderOf(state.column, state.descending);
    table.sorted(state.column, state.descending);
    list(state);
  };
  store.on(['column', 'descending'], sort);
  store.on(['kind', 'text'], list);
  sort(store.get());
}

function listenToKeys(theme, choices, table) {
  const ofFilter = { Escape: choices.clear, Enter: table.focus, ArrowDown: table.focus };
  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = event.target === choices.input;
    const actions = typing ? ofFilter : { '/': choices.focus, l: theme.toggle, L: theme.toggle };
    const action = actions[event.key];
    if (action === undefined) return;
    event.preventDefault();
    action();
  });
}

async function open() {
  const jobs = await readJobs();
  const counts = countOutcomes(jobs);
  const store = createStore({
    theme: initialTheme(),
    kind: 'all',
    text: '',
    column: 'outcome',
    descending: true,
    selected: null,
  });
  const theme = followTheme(store);
  document.title = `${jobs.title} · cscd report`;
  byId('answer-line').textContent = answerOf(jobs.count, counts);
  byId('status').textContent = `${jobs.title} · list ${jobs.list} · ${jobs.generator}`;
  byId('page-tools').append(button('Light or dark', { glyph: SUN, key: 'L' }, theme.toggle));
  addNotes(byId('notes'), jobs, counts);
  const choices = createChoices(byId('choices'), jobs, counts, store);
  const tell = createDetails(byId('details'), jobs);
  const table = createTable(byId('jobs'), jobs, {
    select: (job) => store.set({ selected: job }),
    sort(column) {
      const state = store.get();
      const descending = state.column === column ? !state.descending : table.first(column) === 'descending';
      store.set({ column, descending });
    },
  });
  store.on(['selected'], ({ selected }) => {
    tell(selected);
    table.select(selected);
  });
  byId('opening')?.remove();
  follow(store, jobs, table, choices);
  createLicences(byId('licences'));
  listenToKeys(theme, choices, table);
  Object.assign(window.cscd, { jobs, store });
  performance.mark('cscd-open');
}

window.cscd = {};
window.cscd.ready = open();
window.cscd.ready.catch(showError);
window.addEventListener('error', (event) => showError(event.error ?? event.message));
