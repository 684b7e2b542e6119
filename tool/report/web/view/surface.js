/** A moving mesh. Every triangle has its own corners, so that it has one colour and one normal. */

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, Sphere } from 'three';
import { HIDDEN, surfaceMaterial } from './shading.js';

/** Positions of all vertices at a time, from the frame's middle. */
function localAt(positions, { i, fraction }, out) {
  const a = positions.local(i);
  if (fraction === 0) return a;
  const b = positions.local(i + 1);
  for (let k = 0; k < out.length; k++) out[k] = a[k] + fraction * (b[k] - a[k]);
  return out;
}

/** Three corners and their normal (as signed bytes, the fourth unused) of each triangle. */
function spread(local, triangles, corners, facing) {
  for (let c = 0; c < triangles.length; c += 3) {
    const a = 3 * triangles[c];
    const b = 3 * triangles[c + 1];
    const d = 3 * triangles[c + 2];
    const o = 3 * c;
    const ax = (corners[o] = local[a]);
    const ay = (corners[o + 1] = local[a + 1]);
    const az = (corners[o + 2] = local[a + 2]);
    const ux = (corners[o + 3] = local[b]) - ax;
    const uy = (corners[o + 4] = local[b + 1]) - ay;
    const uz = (corners[o + 5] = local[b + 2]) - az;
    const vx = (corners[o + 6] = local[d]) - ax;
    const vy = (corners[o + 7] = local[d + 1]) - ay;
    const vz = (corners[o + 8] = local[d + 2]) - az;
    const nx = uy * vz - uz * vy;
    const ny = uz * vx - ux * vz;
    const nz = ux * vy - uy * vx;
    const length = Math.sqrt(nx * nx + ny * ny + nz * nz);
    const scale = length > 0 ? 127 / length : 0;
    const n = 4 * c;
    facing[n] = facing[n + 4] = facing[n + 8] = nx * scale;
    facing[n + 1] = facing[n + 5] = facing[n + 9] = ny * scale;
    facing[n + 2] = facing[n + 6] = facing[n + 10] = nz * scale;
  }
}

export class Surface {
  constructor({ triangles, positions }, { shadowed = false } = {}) {
    this.triangles = triangles;
    this.positions = positions;
    this.corners = new Float32Array(3 * triangles.length);
    this.facing = new Int8Array(4 * triangles.length);
    this.tint = new Uint8Array(4 * triangles.length);
    this.between = new Float32Array(3 * positions.vertexCount);
    this.center = [0, 0, 0];
    this.shown = null;
    const geometry = new BufferGeometry();
    const attribute = (array, size, normalized) =>
      new BufferAttribute(array, size, normalized).setUsage(DynamicDrawUsage);
    geometry.setAttribute('position', attribute(this.corners, 3, false));
    geometry.setAttribute('facing', attribute(this.facing, 4, true));
    geometry.setAttribute('tint', attribute(this.tint, 4, true));
    geometry.boundingSphere = new Sphere(undefined, Infinity);
    this.quick = surfaceMaterial({ shadowed });
    this.lined = surfaceMaterial({ lines: true });
    this.mesh = new Mesh(geometry, this.quick);
    this.mesh.frustumCulled = false;
    this.through = new Mesh(new BufferGeometry(), surfaceMaterial({ more: HIDDEN }));
    for (const name of ['position', 'facing', 'tint']) this.through.geometry.setAttribute(name, geometry.getAttribute(name));
    this.through.geometry.boundingSphere = geometry.boundingSphere;
    this.through.frustumCulled = false;
    this.through.renderOrder = 1;
    this.mesh.add(this.through);
    this.showThrough([]);
  }

  /** Moves the mesh to a time; its place is `center`, in double. */
  setTime(time) {
    const place = this.positions.locate(time);
    this.center = this.positions.centerAt(time);
    const record = this.positions.record(place.i);
    if (this.shown !== null && this.shown.record === record && this.shown.fraction === place.fraction) return;
    this.shown = { record, fraction: place.fraction };
    const local = localAt(this.positions, place, this.between);
    this.local = local;
    spread(local, this.triangles, this.corners, this.facing);
    const { attributes } = this.mesh.geometry;
    attributes.position.needsUpdate = true;
    attributes.facing.needsUpdate = true;
  }

  /** @param {Uint8Array} rgb three for each triangle @param {Uint8Array|null} flags what lines it has */
  paint(rgb, flags) {
    const { tint } = this;
    const count = this.triangles.length / 3;
    for (let t = 0; t < count; t++) {
      const from = 3 * t;
      const to = 12 * t;
      for (let k = 0; k < 12; k += 4) {
        tint[to + k] = rgb[from];
        tint[to + k + 1] = rgb[from + 1];
        tint[to + k + 2] = rgb[from + 2];
        tint[to + k + 3] = flags === null ? 0 : flags[t];
      }
    }
    this.mesh.geometry.attributes.tint.needsUpdate = true;
  }

  /** Shows these triangles faintly where the surface hides them. */
  showThrough(triangles) {
    this.through.visible = triangles.length > 0;
    const index = new Uint32Array(3 * triangles.length);
    triangles.forEach((t, i) => {
      for (let corner = 0; corner < 3; corner++) index[3 * i + corner] = 3 * t + corner;
    });
    this.through.geometry.setIndex(new BufferAttribute(index, 1));
  }

  /** Switches the lines along edges, which cost time on each pixel. */
  setLines(wanted) {
    this.mesh.material = wanted ? this.lined : this.quick;
  }
}
