/** Converts the report's coordinates (in double) to those of the view, which is about 1 across, near 0, with z up. */

import { Box3, Quaternion, Sphere, Vector3 } from 'three';

export class Space {
  constructor(positions) {
    const half = positions.half(0);
    this.origin = positions.center(0);
    this.length = 2 * Math.max(...half) || 1;
    this.yUp = false;
    this.rotation = new Quaternion();
  }

  setUp(yUp) {
    this.yUp = yUp;
    this.rotation.setFromAxisAngle(new Vector3(1, 0, 0), yUp ? Math.PI / 2 : 0);
  }

  toView = (point) => {
    const { origin, length } = this;
    const x = (point[0] - origin[0]) / length;
    const y = (point[1] - origin[1]) / length;
    const z = (point[2] - origin[2]) / length;
    return this.yUp ? [x, -z, y] : [x, y, z];
  };

  direction(vector) {
    return this.yUp ? [vector.x, vector.z, -vector.y] : [vector.x, vector.y, vector.z];
  }

  fromView(vector) {
    const turned = this.direction(vector);
    return turned.map((value, axis) => this.origin[axis] + value * this.length);
  }

  place(surface) {
    surface.mesh.position.set(...this.toView(surface.center));
    surface.mesh.quaternion.copy(this.rotation);
    surface.mesh.scale.setScalar(1 / this.length);
  }

  /** The box of all records that have been read. */
  box(positions) {
    const box = new Box3();
    for (let i = 0; i < positions.available; i++) {
      const center = positions.center(i);
      const half = positions.half(i);
      for (const sign of [-1, 1]) {
        box.expandByPoint(new Vector3(...this.toView(center.map((value, axis) => value + sign * half[axis]))));
      }
    }
    return box;
  }

  /** A box around 0 that holds each of them when its middle is there. */
  reach(positions) {
    const most = [0, 0, 0];
    for (let i = 0; i < positions.available; i++) {
      positions.half(i).forEach((value, axis) => {
        most[axis] = Math.max(most[axis], value);
      });
    }
    const corner = this.toView(most.map((value, axis) => value + this.origin[axis])).map(Math.abs);
    return new Box3(new Vector3(...corner).negate(), new Vector3(...corner));
  }
}

export function sphereOf(...boxes) {
  const all = new Box3();
  for (const box of boxes) all.union(box);
  return all.getBoundingSphere(new Sphere());
}
