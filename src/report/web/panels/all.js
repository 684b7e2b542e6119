/** Puts every panel into its place on the page. */
import * as charts from './charts.js';
import * as comparison from './comparison.js';
import * as contacts from './contacts.js';
import * as intervals from './intervals.js';
import * as licences from './licences.js';
import * as notes from './notes.js';
import * as provenance from './provenance.js';
import * as regions from './regions.js';
import * as status from './status.js';
import * as timings from './timings.js';

const PANELS = { status, notes, comparison, charts, contacts, timings, intervals, regions, provenance, licences };

export function createPanels(report, store, player) {
  document.body.dataset.kind = report.kind;
  document.title = `${report.title} · cscd report`;
  document.getElementById('title').textContent = report.title;
  for (const [id, panel] of Object.entries(PANELS)) panel.create(document.getElementById(id), report, store, player);
}
