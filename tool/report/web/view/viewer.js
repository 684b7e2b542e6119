/** The 3D view: builds the scene, and draws it only when something has changed. */

import { Box3, Color, LinearSRGBColorSpace, Scene, Vector3, WebGLRenderer } from 'three';
import { fractionAt, intervalIndexAt } from '../page/intervals.js';
import { View } from './camera.js';
import { Curves } from './curves.js';
import { zoomToEvent } from './framing.js';
import { ContactMarks, DetectorMarks } from './markers.js';
import { Painter } from './paint.js';
import { onClick, pick } from './picking.js';
import { Resolution, createContext } from './resolution.js';
import { Shadow } from './shadow.js';
import { Space, sphereOf } from './space.js';
import { Surface } from './surface.js';

const SCENERY = { light: [226, 225, 221], dark: [78, 82, 92] };
const GROUND = { light: '#f1f3f6', dark: '#1b212b' };
const SHADOWED_IN_SOFTWARE = 30000; // triangles
const FAR_TRAVELLED = 1.3; // body lengths

export class Viewer {
  /** @throws where there is no WebGL */
  constructor(container, report, store, player) {
    this.report = report;
    this.data = report.scene;
    this.store = store;
    this.player = player;
    this.container = container;
    this.framesDrawn = 0;
    this.request = null;
    this.makeRenderer();
    this.makeScene();
    this.makeCamera();
    this.listen();
  }

  makeRenderer() {
    const { canvas, context, software } = createContext();
    this.renderer = new WebGLRenderer({ canvas, context });
    this.renderer.outputColorSpace = LinearSRGBColorSpace; // colours are as on the screen throughout
    this.canvas = canvas;
    for (const [name, value] of [['role', 'img'], ['aria-label', '3D view'], ['tabindex', '0']]) {
      canvas.setAttribute(name, value);
    }
    this.container.append(canvas);
    this.resolution = new Resolution(this, software);
  }

  makeScene() {
    const { data } = this;
    this.space = new Space(data.positions);
    this.space.setUp(this.store.get().up === 'y');
    this.scene = new Scene();
    this.painter = new Painter(data);
    this.body = new Surface(data);
    const cheap = !this.resolution.software || data.triangleCount <= SHADOWED_IN_SOFTWARE;
    this.scenery = data.scenery === null ? null : new Surface(data.scenery, { shadowed: cheap });
    this.shadow = this.scenery !== null && cheap ? new Shadow(this.body, this.scenery) : null;
    this.contacts = new ContactMarks();
    this.detectors = new DetectorMarks();
    this.curves = new Curves();
    this.body.mesh.add(this.curves.object);
    this.scene.add(this.body.mesh, this.contacts.object, this.detectors.object);
    if (this.scenery !== null) this.scene.add(this.scenery.mesh);
    this.setTheme();
  }

  makeCamera() {
    this.view = new View(this.canvas, () => {
      this.touched = true;
      this.resolution.moving();
      this.invalidate();
    });
    this.touched = false;
    this.follows = false;
    this.followed = null;
    this.measure();
    this.resize();
    this.home();
  }

  listen() {
    const redraw = (keys, before) =>
      this.store.on(keys, () => {
        before?.();
        this.invalidate();
      });
    redraw(['time', 'share'], () => this.resolution.moving());
    redraw(['colour', 'answers', 'contacts', 'trail', 'through', 'points', 'cuts', 'edges', 'scenery', 'selected', 'triangle']);
    this.store.on(['event'], ({ event }) => {
      if (event === null) return;
      zoomToEvent(this, this.data.answers.events[event]);
      this.canvas.scrollIntoView({ block: 'nearest' }); // below the list, in narrow windows
    });
    redraw(['theme'], () => this.setTheme());
    redraw(['up'], () => this.setUp());
    new ResizeObserver(() => this.resize()).observe(this.container);
    onClick(this.canvas, (x, y) => pick(this, x, y));
    this.canvas.addEventListener('keydown', (event) => {
      if (!this.view.key(event)) return;
      event.preventDefault();
      event.stopPropagation();
    });
    this.canvas.addEventListener('webglcontextrestored', () => this.invalidate());
    window.addEventListener('beforeprint', () => this.drawNow());
  }

  /** The scene, as far as frames have been read. */
  measure() {
    const { data, space } = this;
    const bodies = data.positions;
    this.whole = space.box(bodies);
    this.reach = space.reach(bodies);
    const size = (box) => Math.max(...box.getSize(new Vector3()).toArray());
    this.travels = size(this.whole) > FAR_TRAVELLED * size(this.reach);
    this.surroundings = data.scenery === null ? new Box3() : space.box(data.scenery.positions);
  }

  /** Call it when more frames have been read. */
  framesRead() {
    this.measure();
    if (!this.touched) this.home();
    this.invalidate();
  }

  home() {
    this.follows = this.travels;
    this.followed = this.bodyPlace();
    this.view.home(this.follows ? this.reach.clone().translate(this.followed) : this.whole);
    this.touched = false;
    this.onHome?.();
    this.invalidate();
  }

  setFollows(follows) {
    this.follows = follows;
    this.followed = this.bodyPlace();
    this.invalidate();
  }

  setUp() {
    this.space.setUp(this.store.get().up === 'y');
    this.measure();
    this.home();
  }

  bodyPlace() {
    return new Vector3(...this.space.toView(this.data.positions.centerAt(this.store.get().time)));
  }

  setTheme() {
    const { theme } = this.store.get();
    this.scene.background = new Color().setStyle(GROUND[theme], LinearSRGBColorSpace);
    if (this.scenery !== null) {
      const colour = SCENERY[theme];
      const rgb = new Uint8Array(this.data.scenery.triangles.length);
      for (let i = 0; i < rgb.length; i++) rgb[i] = colour[i % 3];
      this.scenery.paint(rgb, null);
    }
  }

  resize() {
    const width = Math.max(1, this.container.clientWidth);
    const height = Math.max(1, this.container.clientHeight);
    this.size = { width, height };
    this.resolution.apply();
    this.view.resize(width, height);
    if (!this.touched) this.home();
    this.invalidate();
  }

  invalidate() {
    if (this.request !== null) return;
    this.request = requestAnimationFrame(() => {
      this.request = null;
      this.draw();
    });
  }

  drawNow() {
    if (this.request !== null) cancelAnimationFrame(this.request);
    this.request = null;
    this.draw();
  }

  draw() {
    const state = this.store.get();
    this.update(state);
    if (this.shadow !== null && state.scenery) this.shadow.update(this.renderer, this.reach, this.surroundings);
    this.renderer.render(this.scene, this.view.camera);
    this.framesDrawn++;
    this.resolution.drawn();
  }

  /** Brings what is in the scene to the state. */
  update(state) {
    const { body, scenery, space, view } = this;
    if (this.data.displacement !== null) this.data.positions.setShare(state.share);
    body.setTime(state.time);
    space.place(body);
    if (scenery !== null) {
      scenery.mesh.visible = state.scenery;
      if (state.scenery) {
        scenery.setTime(state.time);
        space.place(scenery);
      }
    }
    if (this.follows) {
      const place = this.bodyPlace();
      view.shift(place.clone().sub(this.followed));
      this.followed = place;
    }
    this.updatePaint(state);
    this.updateMarks(state);
    view.clip(sphereOf(this.whole, state.scenery ? this.surroundings : new Box3()));
    view.camera.updateMatrixWorld();
  }

  updatePaint(state) {
    const key = this.painter.key(state);
    if (key !== this.painted) {
      this.painted = key;
      this.linesMarked = this.painter.paint(state);
      this.body.paint(this.painter.rgb, this.painter.flags);
      this.filledThrough = null;
    }
    const filled = state.through ? this.painter.filled : [];
    if (filled !== this.filledThrough) this.body.showThrough((this.filledThrough = filled));
    this.updateCurves(state);
    this.body.setLines(state.edges || this.linesMarked);
    const { uniforms } = this.body.lined;
    uniforms.edges.value = state.edges ? 0.4 : 0;
    uniforms.density.value = this.resolution.ratio;
  }

  updateCurves(state) {
    const { answers } = this.data;
    const place = answers === null ? -1 : answers.placeOf(state);
    const found = answers !== null && state.answers ? answers.at(place) : null;
    const { record, fraction } = this.body.shown;
    const key = found === null ? 'none' : `${place} ${record?.number} ${fraction}`;
    this.curves.setState(found, this.body.local, key, state.through);
  }

  updateMarks(state) {
    const { data, space } = this;
    this.contacts.setState(data, state, space.toView);
    const points = state.points ? this.detectorPoints(state.time) : null;
    this.detectors.setState(data, points, space.toView);
    const pixel = (2 * Math.tan((this.view.camera.fov * Math.PI) / 360)) / this.size.height;
    for (const marks of [this.contacts, this.detectors]) marks.setScale(this.resolution.ratio, pixel);
  }

  /** The detector points of the recording or, if it has none, those of the plan. */
  detectorPoints(time) {
    const { data } = this;
    if (data.detectorPoints !== null) return data.detectorPoints(intervalIndexAt(time, data), fractionAt(time, data));
    return Float64Array.from(data.plan?.regions.flatMap((region) => region.detector_point) ?? []);
  }

  /** Looks at a box from outside the body; from then on this is the view that the reader has chosen. */
  frameFromOutside(box, outwards) {
    const { camera, controls } = this.view;
    const from = camera.position.clone().sub(controls.target).normalize();
    from.multiplyScalar(0.5).add(outwards).normalize();
    const least = this.scenery === null ? -0.5 : 0.12; // not from below the ground
    const steep = from.dot(camera.up);
    if (steep < least) from.addScaledVector(camera.up, least - steep).normalize();
    if (Math.abs(from.dot(camera.up)) > 0.97) from.addScaledVector(camera.up, -0.4 * Math.sign(from.dot(camera.up))).normalize();
    this.view.frame(box, from.length() > 0.5 ? from : null);
    this.touched = true;
    this.invalidate();
  }

  /** Looks at a box; from then on this is the view that the reader has chosen. */
  frame(box) {
    this.view.frame(box);
    this.touched = true;
    this.invalidate();
  }
}
