/** Shows what is known about the triangle that was clicked. */

import { onCalmly } from '../controls/calm.js';
import { element } from '../page/dom.js';
import { significant } from '../page/format.js';
import { intervalAt } from '../page/intervals.js';

const ORIENTATIONS = ['S0, turns or cannot be told', 'S+, outwards', 'S−, inwards'];

function facts(scene, t, time) {
  const rows = [['Corners', [0, 1, 2].map((corner) => scene.triangles[3 * t + corner]).join(', ')]];
  if (scene.component !== null && scene.componentCount > 1) rows.push(['Component', scene.component[t]]);
  if (scene.charge !== null) rows.push(['Charge per area', `${significant(scene.charge[t], 4)} per length`]);
  if (scene.equalized !== null) rows.push(['Rank of the charge', scene.equalized[t].toFixed(3)]);
  if (scene.region !== null) rows.push(['Region', scene.region[t]]);
  if (scene.orientation !== null) {
    rows.push(['Orientation', ORIENTATIONS[scene.orientation.at(intervalAt(time, scene))[t]]]);
  }
  if (scene.heat !== null) rows.push(['Contacts, all intervals', scene.heat[t]]);
  return rows;
}

export function createReadout(container, scene, store) {
  const box = element('div', { class: 'readout', role: 'group', 'aria-label': 'Picked triangle' });
  box.hidden = true;
  container.append(box);
  const close = element('button', { type: 'button', class: 'icon', 'aria-label': 'Close', title: 'Close' }, '×');
  close.addEventListener('click', () => store.set({ triangle: null }));
  const show = ({ triangle, time }) => {
    box.hidden = triangle === null;
    if (triangle === null) return;
    const list = element('dl', {});
    for (const [name, value] of facts(scene, triangle, time)) {
      list.append(element('dt', {}, name), element('dd', { class: 'number' }, String(value)));
    }
    box.replaceChildren(element('strong', {}, `Triangle ${triangle}`), close, list);
  };
  onCalmly(store, ['triangle', 'time'], show);
}
