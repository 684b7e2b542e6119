/** Gives each triangle its colour, and says which of its edges are drawn. */

import { intervalAt } from '../page/intervals.js';
import {
  DEPTH, DISPLACEMENT, HEAT, INTERSECTING, ONLY_TOUCHING, ORIENTATIONS, PLAIN, TOUCHING, VIRIDIS, heatPlace, limitsOf, regionColour, step,
} from './colours.js';
import { CUT, CUT_CORNER, PICKED, TOUCHES } from './shading.js';
import { around, contactTriangles, cutEdges, trianglesOfVertices } from './topology.js';

const TOUCHING_KIND = 16; // the bit of the kind 'touching'

export class Painter {
  constructor(scene) {
    this.scene = scene;
    this.rgb = new Uint8Array(3 * scene.triangleCount);
    this.flags = new Uint8Array(scene.triangleCount);
    this.limits = scene.charge === null ? null : limitsOf(scene.charge);
    this.mostHeat = scene.heat === null ? 0 : scene.heat.reduce((most, count) => Math.max(most, count), 0);
    this.cuts = null;
    this.touching = new Map();
    this.incidence = null;
    this.deep = new Float32Array(scene.vertexCount);
    this.filled = []; // triangles that intersect or are buried, in the frame shown
  }

  fill(colourOf) {
    const { rgb } = this;
    for (let t = 0; t < this.scene.triangleCount; t++) colourOf(t, rgb, 3 * t);
  }

  fillFromMap(map, placeOf) {
    this.fill((t, rgb, at) => {
      const from = step(placeOf(t));
      rgb[at] = map[from];
      rgb[at + 1] = map[from + 1];
      rgb[at + 2] = map[from + 2];
    });
  }

  fillFromTable(colours, indexOf) {
    this.fill((t, rgb, at) => {
      const colour = colours[indexOf(t)];
      rgb[at] = colour[0];
      rgb[at + 1] = colour[1];
      rgb[at + 2] = colour[2];
    });
  }

  base({ colour, time }) {
    const { scene } = this;
    if (colour === 'charge') {
      const { low, high } = this.limits;
      const scale = high > low ? 1 / (high - low) : 0;
      this.fillFromMap(VIRIDIS, (t) => (scene.charge[t] - low) * scale);
    } else if (colour === 'equalized') {
      this.fillFromMap(VIRIDIS, (t) => scene.equalized[t]);
    } else if (colour === 'region') {
      this.fillFromTable(scene.plan.regions.map((_, region) => regionColour(region)), (t) => scene.region[t]);
    } else if (colour === 'orientation') {
      const orientation = scene.orientation.at(intervalAt(time, scene));
      this.fillFromTable(ORIENTATIONS, (t) => orientation[t]);
    } else if (colour === 'displacement') {
      this.fillDisplacement(scene.displacement.at(scene.displacement.placeOf(time)));
    } else {
      this.fillFromTable([PLAIN], () => 0);
      if (colour === 'heat') this.addHeat();
    }
  }

  /** Each triangle by the mean of its corners. */
  fillDisplacement(moves) {
    const { triangles, displacement } = this.scene;
    const scale = displacement.most > 0 ? 1 / (3 * displacement.most) : 0;
    const sum = (t) => moves[triangles[3 * t]] + moves[triangles[3 * t + 1]] + moves[triangles[3 * t + 2]];
    this.fillFromMap(DISPLACEMENT, (t) => scale * sum(t));
  }

  addHeat() {
    const { heat } = this.scene;
    for (let t = 0; t < heat.length; t++) {
      if (heat[t] === 0) continue;
      const from = step(heatPlace(heat[t], this.mostHeat));
      this.rgb.set(HEAT.subarray(from, from + 3), 3 * t);
    }
  }

  /** Triangles of one contact: the face and those around the vertex, or those at the two edges. */
  trianglesOf(contact) {
    this.incidence ??= trianglesOfVertices(this.scene);
    return contactTriangles(this.scene, this.incidence, contact);
  }

  /** Triangles that take part in the interval's contacts; the last few intervals are remembered. */
  touchingIn(interval) {
    let found = this.touching.get(interval);
    if (found === undefined) {
      const set = new Set();
      const [begin, end] = this.scene.contacts.range(interval);
      for (let contact = begin; contact < end; contact++) for (const t of this.trianglesOf(contact)) set.add(t);
      found = [...set];
      if (this.touching.size > 64) this.touching.clear();
      this.touching.set(interval, found);
    }
    return found;
  }

  /** Fills what intersects, and what is buried by how deep it is. */
  fillAnswers(state) {
    const { scene, deep, rgb } = this;
    const { answers: all } = scene;
    const found = state.answers && all !== null ? all.at(all.placeOf(state)) : null;
    this.filled = [];
    if (found === null) return;
    found.triangles.forEach((t, i) => {
      rgb.set(found.kinds[i] & ~TOUCHING_KIND ? INTERSECTING : ONLY_TOUCHING, 3 * t);
      this.filled.push(t);
    });
    if (found.depths.length === 0) return;
    deep.fill(0);
    found.depthVertices.forEach((vertex, i) => {
      deep[vertex] = found.depths[i];
    });
    this.incidence ??= trianglesOfVertices(scene);
    const buried = new Set();
    for (const vertex of found.depthVertices) for (const t of around(this.incidence, vertex)) buried.add(t);
    for (const t of buried) {
      const depth = Math.max(...[0, 1, 2].map((corner) => deep[scene.triangles[3 * t + corner]]));
      const from = step(all.deepest > 0 ? depth / all.deepest : 0);
      rgb.set(DEPTH.subarray(from, from + 3), 3 * t);
      this.filled.push(t);
    }
  }

  mark({ colour, contacts, cuts, selected, triangle, time }) {
    const { scene, flags, rgb } = this;
    flags.fill(0);
    let lines = false;
    if (cuts && scene.region !== null) {
      this.cuts ??= cutEdges(scene, CUT, CUT_CORNER);
      flags.set(this.cuts);
      lines = true;
    }
    const flag = (bit) => (t) => {
      flags[t] |= bit;
      lines = true;
    };
    if (contacts && scene.contacts !== null) {
      const touching = this.touchingIn(intervalAt(time, scene));
      if (colour === 'plain') for (const t of touching) rgb.set(TOUCHING, 3 * t);
      else touching.forEach(flag(TOUCHES));
    }
    if (selected !== null) this.trianglesOf(selected).forEach(flag(PICKED));
    if (triangle !== null) flag(PICKED)(triangle);
    return lines;
  }

  /** Everything that the painting depends on; while it stays the same, nothing is painted again. */
  key(state) {
    const { scene } = this;
    const moving = state.colour === 'orientation' || (state.contacts && scene.contacts !== null);
    const interval = moving ? intervalAt(state.time, scene) : '';
    const { answers } = scene;
    const found = state.answers && answers !== null ? answers.placeOf(state) : '';
    const moves = state.colour === 'displacement' ? scene.displacement.placeOf(state.time) : '';
    return [found, moves, state.colour, state.contacts, state.cuts, state.selected, state.triangle, interval].join(' ');
  }

  /** @returns {boolean} whether some triangle has lines */
  paint(state) {
    this.base(state);
    const lines = this.mark(state);
    this.fillAnswers(state);
    return lines;
  }
}
