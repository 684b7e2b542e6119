/** Intersection curves as lines of constant width, and faintly where the surface hides them. */

import { GreaterDepth, Group, LessEqualDepth, Sphere } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

const COLOUR = 0x111111;
const HALO = 0xffffff;
const ORDER = [1, 2, 0.5, 3]; // of the passes: the rim of what is hidden lies below the marks of hidden contacts

function material(width, colour, more) {
  return new LineMaterial({
    color: colour,
    linewidth: width,
    polygonOffset: true,
    polygonOffsetFactor: -2,
    polygonOffsetUnits: -8,
    depthWrite: false,
    ...more,
  });
}

/** The ends of all segments, in the coordinates of the body's mesh. */
function segmentsOf({ curveVertices, curveShares, curveBegins }, local) {
  const place = (i, axis) => {
    const a = local[3 * curveVertices[2 * i] + axis];
    const b = local[3 * curveVertices[2 * i + 1] + axis];
    return a + curveShares[i] * (b - a);
  };
  const out = [];
  for (let i = 1; i < curveBegins.length; i++) {
    if (curveBegins[i] === 1) continue;
    for (const end of [i - 1, i]) for (let axis = 0; axis < 3; axis++) out.push(place(end, axis));
  }
  return out;
}

export class Curves {
  constructor() {
    const passes = [
      material(5, HALO, { depthFunc: LessEqualDepth, transparent: true, opacity: 0.85 }),
      material(2.4, COLOUR, { depthFunc: LessEqualDepth }),
      material(5, HALO, { depthFunc: GreaterDepth, transparent: true, opacity: 0.3 }),
      material(2.4, COLOUR, { depthFunc: GreaterDepth, transparent: true, opacity: 0.5 }),
    ];
    this.lines = passes.map((pass, i) => {
      const line = new LineSegments2(new LineSegmentsGeometry(), pass);
      line.frustumCulled = false;
      line.renderOrder = ORDER[i];
      return line;
    });
    this.hidden = this.lines.slice(2);
    this.object = new Group();
    this.object.add(...this.lines);
    this.shown = null;
    this.segments = 0;
  }

  /** @param {object|null} found what intersects in the frame @param {Float32Array} local the body's vertices */
  setState(found, local, key, through) {
    for (const line of this.hidden) line.visible = through;
    if (key === this.shown) return;
    this.shown = key;
    const ends = found === null ? [] : segmentsOf(found, local);
    this.segments = ends.length / 6;
    this.object.visible = ends.length > 0;
    if (ends.length === 0) return;
    const geometry = new LineSegmentsGeometry().setPositions(ends);
    geometry.boundingSphere = new Sphere(undefined, Infinity);
    this.lines[0].geometry.dispose();
    for (const line of this.lines) line.geometry = geometry;
  }
}
