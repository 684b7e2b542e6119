/** Brings the camera to what the reader asks for. */

import { Box3, Vector3 } from 'three';
import { intervalAt } from '../page/intervals.js';

/** Frames the contacts of the interval, or the selected one and its triangles. */
export function zoomToContacts(viewer) {
  const { data, painter, space, store } = viewer;
  const { selected, time } = store.get();
  const interval = intervalAt(time, data);
  viewer.update(store.get()); // where the view follows the body, it does so before
  const [begin, end] = selected === null ? data.contacts.range(interval) : [selected, selected + 1];
  if (begin === end) return;
  const box = new Box3();
  const add = (point) => box.expandByPoint(new Vector3(...space.toView(point)));
  for (let contact = begin; contact < end; contact++) {
    add(data.contacts.point.subarray(3 * contact, 3 * contact + 3));
    for (const t of painter.trianglesOf(contact)) {
      for (let corner = 0; corner < 3; corner++) add(data.positions.vertexAt(data.triangles[3 * t + corner], time));
    }
  }
  viewer.frame(box.expandByScalar(0.15 * box.getSize(new Vector3()).length()));
}
