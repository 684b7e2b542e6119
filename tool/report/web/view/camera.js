/** The camera: turning, panning, zooming, framing. */

import { MOUSE, PerspectiveCamera, TOUCH, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const AZIMUTH = (30 * Math.PI) / 180;
const ELEVATION = (20 * Math.PI) / 180;
const TURN = Math.PI / 24;

/** The point of view of the tool's pictures: from the right and above. */
const DIRECTION = new Vector3(
  Math.sin(AZIMUTH) * Math.cos(ELEVATION),
  -Math.cos(AZIMUTH) * Math.cos(ELEVATION),
  Math.sin(ELEVATION),
);

export class View {
  constructor(canvas, changed) {
    this.camera = new PerspectiveCamera(30, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(DIRECTION);
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, {
      zoomToCursor: true,
      screenSpacePanning: true,
      mouseButtons: { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN },
      touches: { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN },
    });
    this.controls.addEventListener('change', changed);
  }

  resize(width, height) {
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
  }

  /** Looks at a box from a direction (by default the present one) so that all of it is seen. */
  frame(box, direction = null) {
    const { camera, controls } = this;
    const from = direction ?? camera.position.clone().sub(controls.target).normalize();
    const target = box.getCenter(new Vector3());
    const right = new Vector3().crossVectors(camera.up, from).normalize();
    const up = new Vector3().crossVectors(from, right);
    const tall = Math.tan((camera.fov * Math.PI) / 360) * 0.92;
    const wide = tall * camera.aspect;
    let distance = 0;
    for (let i = 0; i < 8; i++) {
      const side = (bit, axis) => (i & bit ? box.max : box.min)[axis];
      const corner = new Vector3(side(1, 'x'), side(2, 'y'), side(4, 'z')).sub(target);
      const depth = corner.dot(from);
      const needed = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / tall);
      distance = Math.max(distance, depth + needed);
    }
    controls.target.copy(target);
    camera.position.copy(target).addScaledVector(from, Math.max(distance, 1e-4));
    controls.update();
  }

  home(box) {
    this.frame(box, DIRECTION);
  }

  /** Moves with the body. */
  shift(by) {
    this.camera.position.add(by);
    this.controls.target.add(by);
  }

  /** Fits the near and far planes to the scene, because depth has few bits. */
  clip(sphere) {
    const { camera } = this;
    const distance = camera.position.distanceTo(sphere.center);
    camera.near = Math.max(distance - 1.05 * sphere.radius, distance * 1e-3, 1e-5);
    const target = camera.position.distanceTo(this.controls.target);
    camera.near = Math.min(camera.near, target / 4);
    camera.far = distance + 1.05 * sphere.radius + camera.near;
    camera.updateProjectionMatrix();
  }

  /** Keys of the focused view: Alt with arrows turns, with Shift too pans, with Page Up and Down zooms. */
  key(event) {
    if (!event.altKey || event.ctrlKey || event.metaKey) return false;
    const { controls } = this;
    const across = { ArrowLeft: 1, ArrowRight: -1 }[event.key] ?? 0;
    const along = { ArrowUp: 1, ArrowDown: -1 }[event.key] ?? 0;
    const nearer = { PageUp: 0.85, PageDown: 1 / 0.85 }[event.key];
    if (nearer !== undefined) this.dolly(nearer);
    else if (across === 0 && along === 0) return false;
    else if (event.shiftKey) this.pan(across, along);
    else this.turn(across * TURN, along * TURN);
    controls.update();
    return true;
  }

  pan(across, along) {
    const { camera, controls } = this;
    const from = camera.position.clone().sub(controls.target);
    const right = new Vector3().crossVectors(camera.up, from).normalize();
    const up = new Vector3().crossVectors(from, right).normalize();
    const length = 0.03 * from.length();
    this.shift(right.multiplyScalar(-across * length).addScaledVector(up, along * length));
  }

  dolly(factor) {
    const { camera, controls } = this;
    camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
  }

  turn(across, along) {
    const { camera, controls } = this;
    const offset = camera.position.clone().sub(controls.target);
    offset.applyAxisAngle(camera.up, -across);
    const right = new Vector3().crossVectors(camera.up, offset).normalize();
    const raised = offset.clone().applyAxisAngle(right, -along);
    const slope = raised.clone().normalize().dot(camera.up);
    if (Math.abs(slope) < 0.998) offset.copy(raised);
    camera.position.copy(controls.target).add(offset);
  }
}
