/** Colours of triangles and marks: maps for values, hues for categories, all told apart with any colour vision. */

import { interpolateInferno, interpolateRdPu, interpolateViridis, interpolateYlGnBu } from 'd3-scale-chromatic';

export const VF = [0, 90, 181];
export const EE = [220, 50, 32];
export const TOUCHING = [255, 176, 66];
/** Triangles that cross others or share area with them, and those that only touch. */
export const INTERSECTING = [222, 45, 38];
export const ONLY_TOUCHING = [255, 221, 125];
export const PLAIN = [184, 196, 214];

/** S0, S+ and S-, numbered as in the array "orientation". */
export const ORIENTATIONS = [
  [240, 228, 66],
  [86, 180, 233],
  [204, 121, 167],
];

const HUES = [
  [86, 180, 233],
  [230, 159, 0],
  [0, 158, 115],
  [213, 94, 0],
  [240, 228, 66],
  [0, 114, 178],
  [204, 121, 167],
];
/** Towards which grey, and how many 256ths of the way: as given, lighter, darker. */
const TONES = [
  [0, 0],
  [255, 128],
  [0, 112],
];

/** The colour map of the tool's pictures. @returns {number[]} 0..255 */
export function regionColour(region) {
  const [target, share] = TONES[Math.floor(region / HUES.length) % TONES.length];
  return HUES[region % HUES.length].map((value) => Math.trunc((value * (256 - share) + target * share) / 256));
}

export const css = (colour) => `rgb(${colour.join(' ')})`;

/** d3's colours come as text, "#rrggbb" or "rgb(r, g, b)". */
function numbers(text) {
  if (text[0] === '#') return [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));
  return text.match(/\d+/g).slice(0, 3).map(Number);
}

function table(map) {
  const out = new Uint8Array(3 * 256);
  for (let i = 0; i < 256; i++) out.set(numbers(map(i / 255)), 3 * i);
  return out;
}

/** Colours of 0..1 in 256 steps, RGB. */
export const VIRIDIS = table(interpolateViridis);
/** The map without its darkest and lightest ends, which could not be seen beside shading and background. */
export const HEAT = table((t) => interpolateInferno(0.22 + 0.72 * t));

/** Depths: from a pink that differs from the body to the darkest purple. */
export const DEPTH = table((t) => interpolateRdPu(0.4 + 0.6 * t));

const FAINT = 0.2;
const towards = (from, to, share) => from.map((value, k) => Math.round(value + share * (to[k] - value)));
/** Displacements: from the colour of what has not moved to dark blue. */
export const DISPLACEMENT = table((t) => css(towards(PLAIN, numbers(interpolateYlGnBu(0.25 + 0.75 * t)), Math.min(1, t / FAINT))));

export const step = (t) => 3 * Math.round(255 * Math.min(1, Math.max(0, t)));

/** Charge is heavy-tailed: the map's ends are percentiles. */
export function limitsOf(values) {
  const sorted = Float32Array.from(values).sort();
  const at = (share) => sorted[Math.round(share * (sorted.length - 1))];
  const least = sorted[0];
  const most = sorted[sorted.length - 1];
  const [low, high] = at(0.98) > at(0.02) ? [at(0.02), at(0.98)] : [least, most];
  return { low, high, below: least < low, above: most > high, least, most };
}

/** 1 .. most on a logarithmic scale, as 0..1. */
export const heatPlace = (count, most) => (most <= 1 ? 1 : Math.log(count) / Math.log(most));
