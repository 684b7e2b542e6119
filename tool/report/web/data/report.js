/** The report as the page uses it: the content of the data blocks, checked and in typed arrays. */

import { answersOf } from './answers.js';
import { BlockError, readArray, readDocument } from './decode.js';
import { FrameStore, PairedFrames } from './frames.js';
import { readTables } from './tables.js';
import { lastAtOrBefore } from '../page/intervals.js';

function below(array, bound, name) {
  for (let i = 0; i < array.length; i++) {
    if (!(array[i] < bound)) throw new BlockError(name, `has ${array[i]} at ${i} where less than ${bound} is possible`);
  }
}

function ofLength(array, length, name) {
  if (array !== null && array.length !== length) {
    throw new BlockError(name, `has ${array.length} numbers where ${length} belong`);
  }
}

async function readArrays(entries) {
  const arrays = {};
  await Promise.all(
    entries.map(async (entry) => {
      arrays[entry.name] = await readArray(entry);
    }),
  );
  return (name) => arrays[name] ?? null;
}

function required(array, name) {
  if (array === null) throw new BlockError(name, 'is missing');
  return array;
}

/** Orientations are stored as the difference from the interval before, four triangles a byte. */
function orientationOf(bytes, scene) {
  if (bytes === null) return null;
  const { triangles: count, frames, last } = scene;
  const intervals = frames.filter((frame) => frame < last);
  const size = Math.ceil(count / 4);
  ofLength(bytes, size * intervals.length, 'orientation');
  for (let i = size; i < bytes.length; i++) bytes[i] ^= bytes[i - size];
  const unpacked = new Uint8Array(count);
  let shown = -1;
  return {
    /** The start of the last kept interval at or before this one: the interval that `at` describes. */
    interval: (interval) => intervals[Math.max(0, lastAtOrBefore(intervals, interval))],
    at(interval) {
      const i = Math.max(0, lastAtOrBefore(intervals, interval));
      if (i !== shown) {
        for (let t = 0; t < count; t++) unpacked[t] = (bytes[i * size + (t >> 2)] >> (2 * (t & 3))) & 3;
        shown = i;
      }
      return unpacked;
    },
  };
}

function detectorPointsOf(numbers, scene) {
  if (numbers === null) return null;
  const regions = scene.plan.regions.length;
  ofLength(numbers, 6 * regions * (scene.numbers.length - 1), 'detector_points');
  /** @param {number} interval counted from the first */
  return (interval, fraction) => {
    const points = new Float64Array(3 * regions);
    const begin = 6 * regions * interval;
    for (let i = 0; i < 3 * regions; i++) {
      const start = begin + 6 * Math.floor(i / 3) + (i % 3);
      points[i] = numbers[start] + fraction * (numbers[start + 3] - numbers[start]);
    }
    return points;
  };
}

function contactsOf(array, scene) {
  if (scene.contacts === null) return null;
  const places = array('contact_interval') ?? new Uint32Array(0);
  below(places, scene.numbers.length - 1, 'contact_interval');
  const interval = Int32Array.from(places, (place) => scene.numbers[place]);
  const contacts = {
    count: interval.length,
    interval, // the frame that it begins with
    kind: array('contact_kind') ?? new Uint8Array(0),
    vertices: array('contact_vertices') ?? new Uint32Array(0),
    fileVertices: array('contact_file_vertices'),
    toi: array('contact_toi') ?? new Float64Array(0),
    point: array('contact_point') ?? new Float64Array(0),
    /** Contacts begin .. end-1 belong to the interval. */
    range: (frame) => [lastAtOrBefore(interval, frame - 1) + 1, lastAtOrBefore(interval, frame) + 1],
  };
  checkContacts(contacts, scene);
  return contacts;
}

function checkContacts(contacts, scene) {
  const { count, interval } = contacts;
  if (count !== scene.contacts.kept) {
    throw new BlockError('contact_interval', `has ${count} contacts where ${scene.contacts.kept} are announced`);
  }
  ofLength(contacts.kind, count, 'contact_kind');
  ofLength(contacts.vertices, 4 * count, 'contact_vertices');
  ofLength(contacts.fileVertices, 4 * count, 'contact_file_vertices');
  ofLength(contacts.toi, count, 'contact_toi');
  ofLength(contacts.point, 3 * count, 'contact_point');
  below(contacts.kind, 2, 'contact_kind');
  below(contacts.vertices, scene.vertices, 'contact_vertices');
  for (let i = 1; i < count; i++) {
    if (interval[i] < interval[i - 1]) throw new BlockError('contact_interval', 'is not ascending');
  }
}

function sceneryOf(array, scene) {
  if (scene.scenery === null) return null;
  const triangles = required(array('scenery_triangles'), 'scenery_triangles');
  ofLength(triangles, 3 * scene.scenery.triangles, 'scenery_triangles');
  below(triangles, scene.scenery.vertices, 'scenery_triangles');
  const bytes = required(array('scenery_frames'), 'scenery_frames');
  const positions = new FrameStore(bytes, scene.scenery.vertices, scene.scenery.frames, 'scenery_frames');
  return { triangles, positions };
}

/** Arrays with a number for each triangle. */
function perTriangle(array, scene) {
  const values = {};
  for (const name of ['component', 'charge', 'equalized', 'region', 'heat']) {
    values[name] = array(name);
    ofLength(values[name], scene.triangles, name);
  }
  if (values.region !== null) below(values.region, scene.plan.regions.length, 'region');
  return values;
}

/** Reports of tools before the frames had numbers have a step of 1. */
function numbersOf({ numbers, first, last }) {
  const found = numbers ?? Array.from({ length: last - first + 1 }, (_, i) => first + i);
  const ascending = found.every((number, i) => Number.isInteger(number) && (i === 0 || number > found[i - 1]));
  if (!ascending || found[0] !== first || found[found.length - 1] !== last) {
    throw new BlockError('cscd-report', 'has frame numbers that are not ascending from the first to the last');
  }
  return found;
}

/** How far vertices have moved, of pages that show it before and after. */
function displacementOf(positions, untangled, unit) {
  if (untangled === null) return null;
  return {
    /** The greatest of all frames, in the page's unit. */
    most: untangled.frames.reduce((most, frame) => Math.max(most, frame.displacement), 0) / unit,
    /** The kept frame that is nearest to a time. */
    placeOf(time) {
      const { i, fraction } = positions.locate(time);
      return fraction >= 0.5 ? i + 1 : i;
    },
    /** Of each vertex, at such a place. */
    at: (place) => positions.moves(place),
  };
}

async function sceneOf(told, untangled) {
  const scene = { ...told, numbers: numbersOf(told) };
  const array = await readArrays(scene.arrays);
  const triangles = required(array('triangles'), 'triangles');
  ofLength(triangles, 3 * scene.triangles, 'triangles');
  below(triangles, scene.vertices, 'triangles');
  const Frames = untangled === null ? FrameStore : PairedFrames;
  const positions = new Frames(required(array('frames'), 'frames'), scene.vertices, scene.frames, 'frames');
  return {
    vertexCount: scene.vertices,
    triangleCount: scene.triangles,
    componentCount: scene.components,
    first: scene.first,
    last: scene.last,
    numbers: scene.numbers, // of all frames, also of those that are not kept
    frames: scene.frames,
    maxError: scene.max_error,
    relativeError: scene.relative_error,
    up: scene.up === 'y' ? 'y' : 'z',
    fps: scene.fps ?? null,
    lengthUnit: scene.length_unit ?? null,
    unit: scene.unit ?? 1, // the file's units that 1 in the page's coordinates is
    plan: scene.plan,
    contactsInfo: scene.contacts,
    triangles,
    positions,
    scenery: sceneryOf(array, scene),
    ...perTriangle(array, scene),
    orientation: orientationOf(array('orientation'), scene),
    detectorPoints: detectorPointsOf(array('detector_points'), scene),
    contacts: contactsOf(array, scene),
    answers: answersOf(array, scene, untangled !== null),
    displacement: displacementOf(positions, untangled, scene.unit ?? 1), // null: there is no before and after
  };
}

/** All but the frames after the first, which `positions.readAll` reads. */
export async function readReport() {
  const content = readDocument();
  await readTables(content.summaries);
  return {
    kind: content.kind,
    title: content.title,
    generator: content.generator,
    summaries: content.summaries,
    preprocess: content.preprocess,
    untangled: content.untangled ?? null,
    scene: content.scene === null ? null : await sceneOf(content.scene, content.untangled ?? null),
  };
}
