/** Finds the contact or triangle under a point of the picture. */

import { Raycaster, Vector2 } from 'three';
import { markersOnScreen } from './onscreen.js';

const NEAR = 9; // CSS pixels

/** The nearest triangle on a ray, in the mesh's own coordinates; null where there is none. */
function pickTriangle(local, triangles, origin, direction) {
  let best = Infinity;
  let picked = null;
  const [ox, oy, oz] = origin;
  const [dx, dy, dz] = direction;
  for (let c = 0; c < triangles.length; c += 3) {
    const a = 3 * triangles[c];
    const b = 3 * triangles[c + 1];
    const d = 3 * triangles[c + 2];
    const e1x = local[b] - local[a];
    const e1y = local[b + 1] - local[a + 1];
    const e1z = local[b + 2] - local[a + 2];
    const e2x = local[d] - local[a];
    const e2y = local[d + 1] - local[a + 1];
    const e2z = local[d + 2] - local[a + 2];
    const px = dy * e2z - dz * e2y;
    const py = dz * e2x - dx * e2z;
    const pz = dx * e2y - dy * e2x;
    const determinant = e1x * px + e1y * py + e1z * pz;
    if (determinant === 0) continue;
    const tx = ox - local[a];
    const ty = oy - local[a + 1];
    const tz = oz - local[a + 2];
    const u = (tx * px + ty * py + tz * pz) / determinant;
    if (!(u >= 0 && u <= 1)) continue;
    const qx = ty * e1z - tz * e1y;
    const qy = tz * e1x - tx * e1z;
    const qz = tx * e1y - ty * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / determinant;
    if (!(v >= 0 && u + v <= 1)) continue;
    const distance = (e2x * qx + e2y * qy + e2z * qz) / determinant;
    if (distance > 0 && distance < best) {
      best = distance;
      picked = c / 3;
    }
  }
  return picked;
}

/** The triangle at a point of the canvas, in CSS pixels. */
function triangleAt(viewer, x, y) {
  const { body, data, size, space, store, view } = viewer;
  const point = new Vector2((2 * x) / size.width - 1, 1 - (2 * y) / size.height);
  viewer.update(store.get());
  const caster = new Raycaster();
  caster.setFromCamera(point, view.camera);
  const from = space.fromView(caster.ray.origin).map((value, axis) => value - body.center[axis]);
  return pickTriangle(body.local, data.triangles, from, space.direction(caster.ray.direction));
}

/** Selects the mark at a point of the canvas, or else the triangle. */
export function pick(viewer, x, y) {
  const near = markersOnScreen(viewer)
    .map(({ contact, screen }) => ({ contact, distance: Math.hypot(screen[0] - x, screen[1] - y) }))
    .filter(({ distance }) => distance < NEAR)
    .sort((a, b) => a.distance - b.distance);
  if (near.length > 0) viewer.player.select(near[0].contact);
  else viewer.store.set({ triangle: triangleAt(viewer, x, y) });
}

/** Calls `clicked(x, y)` (CSS pixels in the element) for a press that is not a drag. */
export function onClick(element, clicked) {
  let start = null;
  element.addEventListener('pointerdown', (event) => {
    start = event.isPrimary && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
  });
  element.addEventListener('pointerup', (event) => {
    if (start === null || !event.isPrimary) return;
    const moved = Math.hypot(event.clientX - start.x, event.clientY - start.y);
    start = null;
    if (moved > 4) return;
    const box = element.getBoundingClientRect();
    clicked(event.clientX - box.left, event.clientY - box.top);
  });
}
