/** Puts every panel into its place on the page. */
import * as answer from './answer.js';
import * as changes from './changes.js';
import * as charts from './charts.js';
import * as comparison from './comparison.js';
import * as contacts from './contacts.js';
import { element } from '../page/dom.js';
import { titleOf } from '../page/names.js';
import * as intervals from './intervals.js';
import * as licences from './licences.js';
import * as notes from './notes.js';
import * as provenance from './provenance.js';
import * as regions from './regions.js';
import * as status from './status.js';
import * as timings from './timings.js';
import * as untangled from './untangled.js';

const PANELS = {
  status,
  answer,
  untangled,
  notes,
  changes,
  comparison,
  charts,
  contacts,
  timings,
  intervals,
  regions,
  provenance,
  licences,
};

/** A panel whose data is missing in the report must not take the other panels with it. */
function createPanel(panel, container, report, store, player) {
  try {
    panel.create(container, report, store, player);
  } catch (error) {
    console.error(error);
    container.hidden = false;
    container.append(
      element('p', {
        class: 'note alarm',
        role: 'alert',
        text: `This part of the report cannot be shown: ${error.message}`,
      }),
    );
  }
}

export function createPanels(report, store, player) {
  document.body.dataset.kind = report.kind;
  const method = document.getElementById('method');
  method.open = report.kind !== 'replay' && report.untangled === null; // whose answer is above
  if (report.untangled !== null) method.querySelector('summary').textContent = 'Provenance and licences';
  window.addEventListener('beforeprint', () => {
    method.open = true;
  });
  document.getElementById('title').textContent = titleOf(report);
  for (const [id, panel] of Object.entries(PANELS))
    createPanel(panel, document.getElementById(id), report, store, player);
}
