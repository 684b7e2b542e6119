/** All that is known of the selected job, in full. */
import { element } from '../page/dom.js';
import { columnsOf } from './columns.js';
import { hrefOf, OUTCOME_NAME } from './words.js';

export function createDetails(container, jobs) {
  container.setAttribute('aria-live', 'polite');
  const columns = columnsOf(jobs).filter(({ name }) => name in jobs.numbers);

  function factsOf(job) {
    const facts = columns
      .map(({ label, text }) => [label, text(job)])
      .filter(([, text]) => text !== '')
      .map(([label, text]) => `${label}: ${text}`);
    return [`No. ${job + 1}`, OUTCOME_NAME[jobs.outcomes[jobs.outcome[job]]], ...facts].join(' · ');
  }

  return (job) => {
    container.hidden = job === null;
    if (job === null) return;
    const href = hrefOf(jobs.links[job]);
    const lines = [
      element('h2', { text: jobs.names[job] }),
      element('p', { class: 'answer', text: jobs.answers[job] }),
      element('p', { class: 'quiet', text: factsOf(job) }),
    ];
    if (jobs.found[job] === 1)
      lines.push(element('p', { text: 'It found what --fail-on, --fail-depth or --max-faces of its run asks for.' }));
    if (href !== null) lines.push(element('p', {}, element('a', { href, text: 'Its own report' }), ` ${jobs.links[job]}`));
    container.replaceChildren(...lines.filter((line) => line.textContent !== ''));
  };
}
