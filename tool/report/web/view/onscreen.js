/** Positions of the marks on the canvas, for the pointer and for tests. */

import { Vector3 } from 'three';

/** The marks and their positions on the canvas, in CSS pixels. */
export function markersOnScreen(viewer) {
  const { data, size, space, store, view } = viewer;
  viewer.update(store.get());
  return viewer.contacts.marked.map(({ contact, interval, age }) => {
    const position = [...data.contacts.point.subarray(3 * contact, 3 * contact + 3)];
    const seen = new Vector3(...space.toView(position)).project(view.camera);
    const screen = [((seen.x + 1) / 2) * size.width, ((1 - seen.y) / 2) * size.height];
    return { contact, kind: data.contacts.kind[contact] === 0 ? 'vf' : 'ee', interval, position, screen, age };
  });
}
