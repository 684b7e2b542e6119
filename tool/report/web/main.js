/** Opens the report: reads the data blocks, then builds the view, the controls and the panels. */

import { followAddress, frameInAddress } from './controls/address.js';
import { createChoices } from './controls/choices.js';
import { button, element } from './page/dom.js';
import { createHelp, listenToKeys } from './controls/keys.js';
import { createPlayer } from './controls/player.js';
import { createStore } from './controls/store.js';
import { followTheme, initialTheme } from './controls/theme.js';
import { createShare } from './controls/share.js';
import { createTransport } from './controls/transport.js';
import { readReport } from './data/report.js';
import { titleOf } from './page/names.js';
import { createPanels } from './panels/all.js';
import { markersOnScreen } from './view/onscreen.js';
import { createView } from './view/tools.js';

const SUN =
  'M8 4.5a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7zM7.3 0h1.4v3H7.3zM7.3 13h1.4v3H7.3zM0 7.3h3v1.4H0zM13 7.3' +
  'h3v1.4h-3z';
const QUESTION =
  'M5 5.5C5 3.6 6.3 2.5 8 2.5s3 1.1 3 2.7c0 1.3-.7 1.9-1.5 2.5-.6.5-.8.8-.8 1.5v.3H7.1V9c0-1.2.5-1.8 1.' +
  '3-2.4.6-.5.9-.8.9-1.4 0-.7-.5-1.2-1.3-1.2-.9 0-1.4.6-1.4 1.5zM7 11h1.9v2H7z';

/** Small recordings are read before the first picture, so that the view frames all of it at once. */
const QUICK_BYTES = 24e6;

const byId = (id) => document.getElementById(id);

function showError(error) {
  console.error(error);
  byId('opening')?.remove();
  if (window.cscd.report === undefined) byId('main').hidden = true;
  const message = element('div', { role: 'alert', class: 'failure' });
  message.append(
    element('strong', {}, 'This report cannot be shown in full.'),
    ' ',
    String(error?.message ?? error),
  );
  document.body.prepend(message);
}

/** The frame to begin with: where vertices moved farthest, of what was untangled. */
function firstFrame({ scene, untangled }) {
  if (untangled === null) return scene.first;
  const kept = untangled.frames.filter(({ frame }) => scene.numbers.includes(frame));
  return kept.reduce((most, one) => (one.displacement > most.displacement ? one : most)).frame;
}

function initialState(report) {
  const { scene } = report;
  const planShown = report.kind === 'preprocess' && scene.region !== null; // there is nothing else to see
  return {
    time: scene === null ? 0 : (frameInAddress(scene) ?? firstFrame(report)),
    share: 0,
    playing: false,
    speed: report.scene?.fps ?? 30,
    loop: false,
    colour: planShown ? 'region' : report.untangled !== null ? 'displacement' : 'plain',
    answers: true,
    event: null,
    contacts: true,
    trail: false,
    through: true,
    points: planShown,
    cuts: planShown,
    edges: false,
    scenery: true,
    selected: null,
    triangle: null,
    theme: initialTheme(),
    up: scene?.up ?? 'z',
  };
}

/** The slices of a long recording are read after its first picture. */
async function readFrames(scene, viewer) {
  const { positions } = scene;
  const told = (store) => {
    if (viewer !== null) viewer.note.textContent = `Reading frames: ${store.available} of ${store.count}`;
  };
  await positions.readAll(told);
  await scene.scenery?.positions.readAll();
  if (viewer === null) return;
  viewer.note.textContent = '';
  viewer.framesRead();
}

function createTools(container, theme, help) {
  container.append(
    button('Light or dark', { glyph: SUN, key: 'L' }, theme.toggle),
    button('Keyboard help', { glyph: QUESTION, key: '?' }, help.toggle),
  );
}

async function createScene(report, store, player) {
  const { scene } = report;
  const quick = scene.frames.length * scene.vertexCount * 12 < QUICK_BYTES;
  if (quick) await Promise.all([scene.positions.readAll(), scene.scenery?.positions.readAll()]);
  const viewer = createView(byId('view'), report, store, player);
  if (scene.displacement !== null) createShare(byId('playback'), store);
  if (scene.last > scene.first) createTransport(byId('playback'), report, store, player);
  createChoices(byId('choices'), scene, viewer !== null, store, report.kind === 'preprocess');
  return viewer;
}

async function open() {
  const hook = window.cscd;
  const report = await readReport();
  document.title = `${titleOf(report)} · cscd report`;
  const store = createStore(initialState(report));
  const theme = followTheme(store);
  const player = report.scene === null ? null : createPlayer(report, store);
  const viewer = report.scene === null ? null : await createScene(report, store, player);
  const help = createHelp();
  createTools(byId('page-tools'), theme, help);
  Object.assign(hook, { report, store, player, viewer, markers: () => markersOnScreen(viewer) });
  createPanels(report, store, player);
  if (report.scene !== null) followAddress(report.scene, store);
  viewer?.resize();
  viewer?.drawNow();
  byId('opening')?.remove();
  performance.mark('cscd-open');
  listenToKeys({ report, store, player, viewer, theme, help });
  if (report.scene !== null) await readFrames(report.scene, viewer);
}

window.cscd = {};
window.cscd.ready = open();
window.cscd.ready.catch(showError);
window.addEventListener('error', (event) => showError(event.error ?? event.message));
