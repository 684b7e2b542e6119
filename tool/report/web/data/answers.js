/** What intersects in each frame, and the events, as the page uses them. */

import { lengthText } from '../page/format.js';
import { BlockError } from './decode.js';
import { lastAtOrBefore } from '../page/intervals.js';

const COUNTS = 5; // of each frame: pairs that cross, pairs that touch, triangles, points, depths

/** Where the triangles, points and depths of each frame begin. */
function offsetsOf(counts, frames) {
  const offsets = [];
  const next = [0, 0, 0];
  for (let i = 0; i <= frames; i++) {
    offsets.push([...next]);
    if (i < frames) for (let k = 0; k < 3; k++) next[k] += counts[COUNTS * i + 2 + k];
  }
  return offsets;
}

function checkLengths(arrays, end) {
  const wanted = { answer_triangle: end[0], answer_kind: end[0], curve_vertices: 2 * end[1], curve_share: end[1],
    curve_begins: end[1], depth_vertex: end[2], depth: end[2] };
  for (const [name, length] of Object.entries(wanted)) {
    if (arrays[name].length !== length) throw new BlockError(name, `has ${arrays[name].length} numbers where ${length} belong`);
  }
}

function checkBounds(values, bound, name) {
  for (const value of values) if (!(value < bound)) throw new BlockError(name, `has ${value} where less than ${bound} is possible`);
}

const NAMES = ['answer_frame', 'answer_counts', 'answer_triangle', 'answer_kind', 'curve_vertices', 'curve_share',
  'curve_begins', 'depth_vertex', 'depth'];

/** null where frames were not checked. @param {boolean} paired each frame is there before and after */
export function answersOf(array, scene, paired) {
  if (!scene.answers) return null;
  const arrays = Object.fromEntries(NAMES.map((name) => [name, array(name)]));
  for (const name of NAMES) if (arrays[name] === null) throw new BlockError(name, 'is missing');
  const places = [...arrays.answer_frame];
  const counts = arrays.answer_counts;
  const offsets = offsetsOf(counts, places.length);
  checkLengths(arrays, offsets[places.length]);
  const sides = paired ? 2 : 1;
  const numberOf = (place) => scene.numbers[Math.floor(place / sides)];
  checkBounds(places, sides * scene.numbers.length, 'answer_frame');
  checkBounds(arrays.answer_triangle, scene.triangles, 'answer_triangle');
  checkBounds(arrays.curve_vertices, scene.vertices, 'curve_vertices');
  checkBounds(arrays.depth_vertex, scene.vertices, 'depth_vertex');
  const of = (kind, i) => [offsets[i][kind], offsets[i + 1][kind]];
  const frame = (i) => ({
    crossing: counts[COUNTS * i],
    touching: counts[COUNTS * i + 1],
    triangles: arrays.answer_triangle.subarray(...of(0, i)),
    kinds: arrays.answer_kind.subarray(...of(0, i)),
    curveVertices: arrays.curve_vertices.subarray(2 * of(1, i)[0], 2 * of(1, i)[1]),
    curveShares: arrays.curve_share.subarray(...of(1, i)),
    curveBegins: arrays.curve_begins.subarray(...of(1, i)),
    depthVertices: arrays.depth_vertex.subarray(...of(2, i)),
    depths: arrays.depth.subarray(...of(2, i)),
  });
  return {
    ...scene.answers,
    events: (scene.answers.events ?? []).map((event) => ({ ...event, deep: lengthText(event.depth, scene.length_unit ?? null) })),
    /** The numbers of the frames in which triangles cross. */
    crossingFrames: places.filter((_, i) => counts[COUNTS * i] > 0).map(numberOf),
    touchingFrames: places.filter((_, i) => counts[COUNTS * i + 1] > 0).map(numberOf),
    deepest: arrays.depth.reduce((most, depth) => Math.max(most, depth), 0),
    /** What was found in the frame that is nearest to a time, as `place` says; null: nothing. */
    at(place) {
      const i = lastAtOrBefore(places, place);
      return i >= 0 && places[i] === place ? frame(i) : null;
    },
    /** The number of the frame of a place. */
    numberOf,
    /** The place of the frame nearest to a time: what intersects is known of frames, and not in between. */
    placeOf({ time, share }) {
      const { numbers } = scene;
      const i = Math.max(0, lastAtOrBefore(numbers, time));
      const nearest = i + 1 < numbers.length && numbers[i + 1] - time < time - numbers[i] ? i + 1 : i;
      return sides * nearest + (paired && share >= 0.5 ? 1 : 0);
    },
  };
}
