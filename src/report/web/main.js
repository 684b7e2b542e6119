/** Opens the report: reads the data blocks, then builds the view, the controls and the panels. */

import { element } from './controls/dom.js';
import { createPlayer } from './controls/player.js';
import { createStore } from './controls/store.js';
import { followTheme, initialTheme } from './controls/theme.js';
import { readReport } from './data/report.js';
import { createPanels } from './panels/all.js';

function showError(error) {
  console.error(error);
  const message = element('div', { role: 'alert', class: 'failure' });
  message.append(
    element('strong', {}, 'This report cannot be shown in full.'),
    ' ',
    String(error?.message ?? error),
  );
  document.body.prepend(message);
}

function initialState(report) {
  const { scene } = report;
  return {
    time: scene?.first ?? 0,
    playing: false,
    speed: 30,
    loop: false,
    colour: report.kind === 'preprocess' && scene.region !== null ? 'region' : 'plain',
    contacts: true,
    trail: false,
    through: true,
    points: false,
    cuts: false,
    edges: false,
    scenery: true,
    selected: null,
    triangle: null,
    theme: initialTheme(),
  };
}

async function open() {
  const hook = window.cscd;
  const report = await readReport();
  document.title = `${report.title} · cscd report`;
  const store = createStore(initialState(report));
  followTheme(store);
  const player = report.scene === null ? null : createPlayer(report, store);
  Object.assign(hook, { report, store, player });
  createPanels(report, store, player);
  await report.scene?.positions.readAll();
}

window.cscd = {};
window.cscd.ready = open();
window.cscd.ready.catch(showError);
window.addEventListener('error', (event) => showError(event.error ?? event.message));
