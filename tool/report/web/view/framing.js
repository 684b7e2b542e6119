/** Brings the camera to what the reader asks for. */

import { Box3, Vector3 } from 'three';
import { intervalAt } from '../page/intervals.js';

const AROUND = 0.12; // of the body's longest side, to each side of an event

/** Goes to the place of an event, in its worst frame, which is shown. */
export function zoomToEvent(viewer, event) {
  const { data, reach, space, store } = viewer;
  viewer.update(store.get());
  if (event.point === null) return;
  const place = new Vector3(...space.toView(event.point));
  const size = Math.max(...reach.getSize(new Vector3()).toArray());
  const half = Math.max(AROUND * size, (1.5 * event.depth) / data.unit / space.length);
  const outwards = place.clone().sub(viewer.bodyPlace());
  const away = outwards.length() / size;
  const box = new Box3().setFromCenterAndSize(place, new Vector3(1, 1, 1).multiplyScalar(2 * half));
  viewer.frameFromOutside(box, away > 1e-3 ? outwards.normalize() : new Vector3());
}

const FAR = 0.5; // of the farthest

/** Goes to where vertices moved far, in the frame shown. */
export function zoomToMoves(viewer) {
  const { data, reach, space, store } = viewer;
  viewer.update(store.get());
  const place = data.displacement.placeOf(store.get().time);
  const moves = data.displacement.at(place);
  const most = moves.reduce((far, distance) => Math.max(far, distance), 0);
  if (most === 0) return;
  const box = new Box3();
  moves.forEach((distance, vertex) => {
    if (distance < FAR * most) return;
    box.expandByPoint(new Vector3(...space.toView(data.positions.vertexAt(vertex, store.get().time))));
  });
  const size = Math.max(...reach.getSize(new Vector3()).toArray());
  const outwards = box.getCenter(new Vector3()).sub(viewer.bodyPlace());
  const away = outwards.length() / size;
  viewer.frameFromOutside(box.expandByScalar(AROUND * size), away > 1e-3 ? outwards.normalize() : new Vector3());
}

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
