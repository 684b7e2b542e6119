/** The filter by words and by outcome, and how many jobs it leaves. */
import { element, segments } from '../page/dom.js';
import { counted, integer } from '../page/format.js';
import { ROWS_MAX } from './table.js';
import { OUTCOME_NAME } from './words.js';

const ORDER = ['failed', 'found', 'crossing', 'inside', 'touching', 'duplicate', 'missing', 'clean'];

const nameOf = (kind) => (kind === 'found' ? 'fail by the rules' : OUTCOME_NAME[kind]);

/** @returns {{say: (listed: number) => void, focus: () => void}} */
export function createChoices(container, jobs, counts, store) {
  const input = element('input', {
    type: 'search',
    'aria-label': 'Filter by words',
    placeholder: 'Words of name, answer or reason (/)',
    spellcheck: 'false',
    autocomplete: 'off',
    oninput: () => store.set({ text: input.value }),
  });
  const kinds = ORDER.filter((kind) => counts[kind] > 0).map((kind) => [
    kind,
    `${nameOf(kind)} ${integer(counts[kind])}`,
  ]);
  const choice = segments('Outcomes listed', 'outcome', [['all', 'all'], ...kinds], 'all', (kind) => store.set({ kind }));
  const listed = element('p', { class: 'quiet', role: 'status' });
  container.append(input, choice, listed);
  return {
    say(count) {
      const shown = count > ROWS_MAX ? `, the first ${integer(ROWS_MAX)} of them shown` : '';
      listed.textContent =
        count === jobs.count ? `all ${counted(count, 'job')}${shown}` : `${counted(count, 'job')} of ${integer(jobs.count)}${shown}`;
    },
    focus() {
      input.focus();
      input.select();
    },
    clear() {
      input.value = '';
      store.set({ text: '' });
    },
    input,
  };
}
