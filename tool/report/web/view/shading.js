/** The surface's material: one light from over the reader's shoulder, lines along chosen edges. */

import {
  ConstantAlphaFactor, CustomBlending, DoubleSide, GLSL3, GreaterDepth, OneMinusConstantAlphaFactor, ShaderMaterial, Vector3,
} from 'three';
import { TOUCHING } from './colours.js';

/** Bits of a triangle's flags, which travel in the fourth byte of its colour. */
export const CUT = [1, 2, 4]; // the edge opposite to corner 0, 1, 2 lies between regions
export const TOUCHES = 8;
export const PICKED = 16;
export const CUT_CORNER = [32, 64, 128]; // a cut passes the corner: lines of other triangles go on in this one

/** All corners of a triangle have its normal, so that the light is computed per corner and not per pixel. */
const VERTEX = /* glsl */ `
in vec4 tint;
in vec4 facing;
out vec3 colour;
#ifdef SHADOWED
uniform mat4 shadowMatrix;
out vec3 below;
#endif
#ifdef LINES
out vec3 corner;
flat out int flags;
#endif
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  vec3 n = normalize(normalMatrix * facing.xyz);
  float inside = step(0.0, dot(n, seen.xyz));
  n = mix(n, -n, inside);
  float key = 0.5 + 0.5 * dot(n, normalize(vec3(-0.45, 0.65, 0.62)));
  float fill = 0.5 + 0.5 * dot(n, vec3(0.8, -0.35, 0.48));
  float light = 0.34 + 0.68 * key * key + 0.10 * fill;
  colour = tint.rgb * light * (1.0 - 0.3 * inside);
#ifdef LINES
  int which = gl_VertexID % 3;
  corner = vec3(which == 0, which == 1, which == 2);
  flags = int(tint.a * 255.0 + 0.5);
#endif
#ifdef SHADOWED
  below = 0.5 + 0.5 * (shadowMatrix * modelMatrix * vec4(position, 1.0)).xyz;
#endif
  gl_Position = projectionMatrix * seen;
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
in vec3 colour;
out vec4 pixel;
#ifdef SHADOWED
in vec3 below;
uniform highp sampler2DShadow shadowMap;
float lit() {
  vec2 inner = abs(below.xy - 0.5);
  if (max(inner.x, inner.y) > 0.5 || below.z > 1.0) return 1.0;
  return mix(0.74, 1.0, texture(shadowMap, vec3(below.xy, below.z - 0.004)));
}
#endif
#ifdef LINES
in vec3 corner;
flat in int flags;
uniform float density;
uniform float edges;
uniform vec3 cutColour;
uniform vec3 touchColour;
uniform vec3 pickColour;
uniform vec3 edgeColour;
/** The distance in pixels to the corner with these barycentric coordinates. */
float reach(vec2 there) {
  vec2 right = dFdx(corner.xy), up = dFdy(corner.xy), way = there - corner.xy;
  float area = right.x * up.y - right.y * up.x;
  return length(vec2(way.x * up.y - way.y * up.x, right.x * way.y - right.y * way.x)) / max(abs(area), 1e-12);
}
float line(float distance, float width) {
  return 1.0 - smoothstep(width - 0.5, width + 0.5, distance / density);
}
#endif
void main() {
#ifdef LINES
  vec3 distances = corner / max(fwidth(corner), 1e-7);
  float nearest = min(distances.x, min(distances.y, distances.z));
  vec3 edge = vec3((flags & 1) != 0 ? distances.x : 1e6, (flags & 2) != 0 ? distances.y : 1e6,
                   (flags & 4) != 0 ? distances.z : 1e6);
  float cut = min(edge.x, min(edge.y, edge.z));
  if ((flags & 32) != 0) cut = min(cut, reach(vec2(1.0, 0.0)));
  if ((flags & 64) != 0) cut = min(cut, reach(vec2(0.0, 1.0)));
  if ((flags & 128) != 0) cut = min(cut, reach(vec2(0.0, 0.0)));
  vec3 c = mix(colour, edgeColour, edges * line(nearest, 0.5));
  if ((flags & 8) != 0) c = mix(c, touchColour, line(nearest, 1.3));
  c = mix(c, cutColour, line(cut, 1.2));
  if ((flags & 16) != 0) c = mix(c, pickColour, max(line(nearest, 1.8), 0.25));
  pixel = vec4(c, 1.0);
#elif defined(SHADOWED)
  pixel = vec4(colour * lit(), 1.0);
#else
  pixel = vec4(colour, 1.0);
#endif
}`;

const unit = (colour) => new Vector3(...colour.map((value) => value / 255));

/** What makes a material one for what the surface in front hides. */
export const HIDDEN = {
  transparent: true,
  depthWrite: false,
  depthFunc: GreaterDepth,
  blending: CustomBlending,
  blendSrc: ConstantAlphaFactor,
  blendDst: OneMinusConstantAlphaFactor,
  blendAlpha: 0.5,
};

/** The material with lines along edges, with shadow, or with neither. */
export function surfaceMaterial({ lines = false, shadowed = false, more = {} }) {
  return new ShaderMaterial({
    ...more,
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: DoubleSide,
    defines: { ...(lines ? { LINES: 1 } : {}), ...(shadowed ? { SHADOWED: 1 } : {}) },
    uniforms: {
      shadowMap: { value: null },
      shadowMatrix: { value: null },
      density: { value: 1 },
      edges: { value: 0 },
      cutColour: { value: unit([20, 22, 28]) },
      touchColour: { value: unit(TOUCHING) },
      pickColour: { value: unit([255, 255, 255]) },
      edgeColour: { value: unit([30, 34, 44]) },
    },
  });
}
