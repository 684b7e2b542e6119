/** Marks of constant size on the screen: contacts (discs and diamonds) and detector points (rings with a cross). */

import {
  BufferAttribute, BufferGeometry, DynamicDrawUsage, GLSL3, GreaterDepth, Group, LessEqualDepth, Points, ShaderMaterial,
  Sphere,
} from 'three';
import { intervalIndexAt } from '../page/intervals.js';
import { EE, VF, regionColour } from './colours.js';

export const TRAIL = 8; // intervals
const DISC = 0;
const DIAMOND = 1;
const RING = 2;
const STRONG = 4; // added to the shape of what is to be seen even where it is hidden

const VERTEX = /* glsl */ `
in vec4 tint;
in vec2 form;
out vec4 colour;
flat out float code;
flat out float extent;
uniform float density;
uniform float pixel;
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  float size = form.y + 3.0;
  seen.xyz *= 1.0 - min(0.5, 0.75 * size * pixel);
  gl_Position = projectionMatrix * seen;
  gl_PointSize = size * density;
  colour = tint;
  code = form.x;
  extent = size * density;
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
in vec4 colour;
flat in float code;
flat in float extent;
out vec4 pixel;
uniform float density;
uniform float strength;
uniform float rimmed;
void main() {
  bool strong = code > 3.5;
  float shape = strong ? code - 4.0 : code;
  vec2 at = (gl_PointCoord - 0.5) * extent / density;
  float half_size = 0.5 * extent / density - 1.0;
  float round_distance = length(at) - half_size;
  float diamond = (abs(at.x) + abs(at.y) - half_size) * 0.7071;
  float outside = shape == 1.0 ? diamond : round_distance;
  float soft = 0.5 / density;
  float cover = 1.0 - smoothstep(-soft, soft, outside);
  float rim = smoothstep(-soft, soft, outside + 1.4);
  vec3 inner = colour.rgb;
  if (shape == 2.0) {
    float cross = min(abs(at.x), abs(at.y)) - 0.9;
    float hollow = 1.0 - smoothstep(-soft, soft, outside + 4.2);
    float drawn = max(1.0 - hollow, 1.0 - smoothstep(-soft, soft, cross));
    inner = mix(vec3(1.0), inner, drawn);
  }
  float opacity = strong ? max(strength, 0.85) : strength;
  pixel = vec4(mix(inner, vec3(1.0), rim * (strong ? 1.0 : rimmed)), cover * colour.a * opacity);
  if (pixel.a < 0.01) discard;
}`;

function material(strength, rimmed, depth) {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    transparent: true,
    depthWrite: false,
    ...depth,
    uniforms: {
      density: { value: 1 },
      pixel: { value: 0.001 },
      strength: { value: strength },
      rimmed: { value: rimmed },
    },
  });
}

function geometryFor(capacity) {
  const geometry = new BufferGeometry();
  const attribute = (array, size, normalized) =>
    new BufferAttribute(array, size, normalized).setUsage(DynamicDrawUsage);
  geometry.setAttribute('position', attribute(new Float32Array(3 * capacity), 3, false));
  geometry.setAttribute('tint', attribute(new Uint8Array(4 * capacity), 4, true));
  geometry.setAttribute('form', attribute(new Float32Array(2 * capacity), 2, false));
  geometry.setDrawRange(0, 0);
  geometry.boundingSphere = new Sphere(undefined, Infinity);
  return geometry;
}

/** Draws marks, and faintly those that the surface hides. */
class Marks {
  constructor() {
    this.capacity = 64;
    this.geometry = geometryFor(this.capacity);
    this.inSight = new Points(this.geometry, material(1, 1, { depthFunc: LessEqualDepth }));
    this.hidden = new Points(this.geometry, material(0.42, 0.5, { depthFunc: GreaterDepth }));
    this.inSight.renderOrder = 2;
    this.hidden.renderOrder = 1;
    this.object = new Group();
    this.object.add(this.inSight, this.hidden);
    this.inSight.frustumCulled = false;
    this.hidden.frustumCulled = false;
  }

  /** @param {{place: number[], colour: number[], alpha: number, shape: number, size: number}[]} marks in view space */
  show(marks) {
    if (marks.length > this.capacity) {
      this.capacity = 2 * marks.length;
      this.geometry.dispose();
      this.geometry = geometryFor(this.capacity);
      this.inSight.geometry = this.geometry;
      this.hidden.geometry = this.geometry;
    }
    const { position, tint, form } = this.geometry.attributes;
    marks.forEach(({ place, colour, alpha, shape, size }, i) => {
      position.array.set(place, 3 * i);
      tint.array.set([...colour, Math.round(255 * alpha)], 4 * i);
      form.array.set([shape, size], 2 * i);
    });
    for (const attribute of [position, tint, form]) attribute.needsUpdate = true;
    this.geometry.setDrawRange(0, marks.length);
    this.object.visible = marks.length > 0;
  }

  /** @param {number} density device pixels per CSS pixel, @param {number} pixel a CSS pixel's size at distance 1 */
  setScale(density, pixel) {
    for (const { uniforms } of [this.inSight.material, this.hidden.material]) {
      uniforms.density.value = density;
      uniforms.pixel.value = pixel;
    }
  }
}

/** The contacts to be marked, the oldest first so that the newest lie on top. */
export function markedContacts(scene, state) {
  if (scene.contacts === null || !state.contacts) return [];
  const now = intervalIndexAt(state.time, scene);
  const marked = [];
  const oldest = state.trail ? Math.max(0, now - TRAIL) : now;
  for (let i = oldest; i <= now; i++) {
    const interval = scene.numbers[i];
    const [begin, end] = scene.contacts.range(interval);
    for (let contact = begin; contact < end; contact++) marked.push({ contact, interval, age: now - i });
  }
  return marked;
}

/** The diameter of marks in CSS pixels; it is smaller if there are many. */
const sizeAmong = (count) => Math.min(10, Math.max(6.5, 10 - 0.9 * Math.log2(count / 24)));

export class ContactMarks extends Marks {
  /** @param {(point: number[]) => number[]} toView */
  setState(scene, state, toView) {
    this.marked = markedContacts(scene, state);
    this.hidden.visible = state.through;
    const { kind, point } = scene.contacts ?? {};
    const size = sizeAmong(this.marked.length);
    const selected = ({ contact }) => contact === state.selected;
    const selectedLast = [...this.marked].sort((a, b) => selected(a) - selected(b));
    this.show(
      selectedLast.map(({ contact, age }) => ({
        place: toView(point.subarray(3 * contact, 3 * contact + 3)),
        colour: kind[contact] === 0 ? VF : EE,
        alpha: age === 0 ? 1 : 0.75 * (1 - age / (TRAIL + 1)),
        shape: (kind[contact] === 0 ? DISC : DIAMOND) + (contact === state.selected ? STRONG : 0),
        size: (contact === state.selected ? 19 : size - (age > 0 ? 2 : 0)) + (kind[contact] === 0 ? 0 : 2),
      })),
    );
  }
}

/** The diameter of a ring in CSS pixels; it is smaller if there are many. */
const ringAmong = (count) => Math.min(19, Math.max(11, 19 - 2 * Math.log2(count / 24)));

/** Detector points lie inside the body, so they are always drawn over it. */
export class DetectorMarks extends Marks {
  constructor() {
    super();
    this.hidden.material.uniforms.strength.value = 1;
    this.hidden.material.uniforms.rimmed.value = 1;
  }

  setState(scene, points, toView) {
    const marks = [];
    const size = ringAmong((points?.length ?? 0) / 3);
    for (let region = 0; points !== null && 3 * region < points.length; region++) {
      const place = toView(points.subarray(3 * region, 3 * region + 3));
      marks.push({ place, colour: regionColour(region), alpha: 1, shape: RING, size });
    }
    this.show(marks);
  }
}
