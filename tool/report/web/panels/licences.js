/** The full licences of the libraries in this page. */
import { element, heading } from '../page/dom.js';

export function create(container) {
  const texts = document.getElementById('licence-texts')?.textContent.trim() ?? '';
  container.hidden = texts === '';
  if (container.hidden) return;
  container.append(
    heading('Licences', element('span', { class: 'quiet', text: 'of the software in this page' })),
  );
  for (const text of texts.split('\n\n----\n\n')) {
    const end = text.indexOf('\n');
    container.append(
      element(
        'details',
        {},
        element('summary', { text: text.slice(0, end) }),
        element('pre', { text: text.slice(end).trim(), tabindex: 0 }),
      ),
    );
  }
}
