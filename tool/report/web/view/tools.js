/** The view with its buttons, legend and readout, or a message if it cannot be drawn. */

import { button, element } from '../page/dom.js';
import { moment } from '../page/format.js';
import { intervalAt } from '../page/intervals.js';
import { zoomToContacts, zoomToMoves } from './framing.js';
import { createLegend } from './legend.js';
import { createReadout } from './readout.js';
import { Viewer } from './viewer.js';

const HOUSE = 'M8 2 1.5 8H3.5v6h3.5v-4h2v4h3.5V8h2z';
const LOUPE =
  'M6.5 1.5a5 5 0 1 0 3 9l3.8 3.8 1.2-1.2-3.8-3.8a5 5 0 0 0-4.2-8z' +
  'm0 1.8a3.2 3.2 0 1 1 0 6.4 3.2 3.2 0 0 1 0-6.4z';

const CAMERA =
  'M5.5 3 6.5 1.5h3L10.5 3H14v11H2V3zM8 5.2a3.3 3.3 0 1 0 0 6.6 3.3 3.3 0 0 0 0-6.6z' +
  'm0 1.6a1.7 1.7 0 1 1 0 3.4 1.7 1.7 0 0 1 0-3.4z';

const KEYS =
  'Alt with arrows turns the view, Alt and Shift with arrows pans, Alt with Page Up or Down zooms; ? lists all keys.';

/** A button that stays pressed. */
function toggle(name, text, title, pressed, action) {
  const made = element('button', { type: 'button', 'aria-label': name, 'aria-pressed': pressed, title }, text);
  made.addEventListener('click', () => {
    const now = made.getAttribute('aria-pressed') !== 'true';
    made.setAttribute('aria-pressed', String(now));
    action(now);
  });
  return made;
}

/** Saves what the view shows as a PNG. */
function savePicture(viewer, report) {
  viewer.resolution.stop();
  viewer.drawNow();
  viewer.canvas.toBlob((blob) => {
    const link = element('a', {
      href: URL.createObjectURL(blob),
      download: `${report.title.replace(/[^\w.-]+/g, '_')}-${moment(viewer.store.get().time)}.png`,
    });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }, 'image/png');
}

function tools(viewer, store) {
  const { data } = viewer;
  const reset = button('Reset view', { glyph: HOUSE, key: '0' }, () => viewer.home());
  const row = element('div', { class: 'view-tools' }, reset);
  if (data.displacement !== null) {
    row.append(button('Zoom to where vertices moved', { glyph: LOUPE, key: 'Z' }, () => zoomToMoves(viewer)));
  }
  if (data.contacts !== null) {
    const zoom = button('Zoom to contacts', { glyph: LOUPE, key: 'Z' }, () => zoomToContacts(viewer));
    const update = (state) => {
      const [begin, end] = data.contacts.range(intervalAt(state.time, data));
      zoom.disabled = begin === end && state.selected === null;
    };
    store.on(['time', 'selected'], update);
    update(store.get());
    row.append(zoom);
  }
  const follow = toggle('Follow the body', 'Follow', 'Let the view travel with the body', viewer.follows, (on) =>
    viewer.setFollows(on),
  );
  viewer.onHome = () => follow.setAttribute('aria-pressed', String(viewer.follows));
  if (data.last > data.first) row.append(follow);
  row.append(button('Save picture', { glyph: CAMERA, key: 'S' }, () => savePicture(viewer, viewer.report)));
  viewer.savePicture = () => savePicture(viewer, viewer.report);
  return row;
}

/** @returns {Viewer|null} null where there is no WebGL: the rest of the page works without it */
export function createView(container, report, store, player) {
  let viewer;
  try {
    viewer = new Viewer(container, report, store, player);
  } catch (error) {
    console.info('no 3D view:', error.message);
    container.replaceChildren(
      element(
        'p',
        { class: 'view-missing', role: 'note' },
        'This browser offers no WebGL, so the 3D view cannot be drawn. Charts, tables and lists below work without it.',
      ),
    );
    container.dataset.missing = 'webgl';
    return null;
  }
  viewer.canvas.addEventListener('webglcontextlost', () => {
    note.textContent = 'The graphics system has dropped the picture; reload the page if it does not come back.';
  });
  viewer.canvas.addEventListener('webglcontextrestored', () => {
    note.textContent = '';
  });
  const keys = element('p', { class: 'visually-hidden', id: 'view-keys' }, KEYS);
  viewer.canvas.setAttribute('aria-describedby', 'status view-keys');
  const note = element('p', { class: 'view-note', 'aria-live': 'polite' });
  container.append(tools(viewer, store), note, keys);
  viewer.note = note;
  createLegend(container, report, store, viewer.painter);
  createReadout(container, report.scene, store);
  return viewer;
}
