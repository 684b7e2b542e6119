/** Frame records: positions on a grid, each frame as its difference from the one before. */

import { BlockError } from './decode.js';

const KEY = 1;
const SLICE_MS = 24;

/** Reads records one after another; `q` holds the grid coordinates of the last, axis by axis. */
class RecordReader {
  constructor(bytes, vertexCount, name) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.vertexCount = vertexCount;
    this.name = name;
    this.offset = 0;
    this.origin = [0, 0, 0];
    this.step = 0;
    this.q = null;
  }

  need(size, frame) {
    if (this.offset + size > this.bytes.length) throw new BlockError(this.name, `ends within frame record ${frame}`);
    const at = this.offset;
    this.offset += size;
    return at;
  }

  readHeader(frame) {
    const kind = this.bytes[this.need(1, frame)];
    if (kind === KEY) {
      const at = this.need(32, frame);
      this.origin = [0, 8, 16].map((byte) => this.view.getFloat64(at + byte, true));
      this.step = this.view.getFloat64(at + 24, true);
      this.q = new Int32Array(3 * this.vertexCount);
      return [0, 0, 0];
    }
    if (kind !== 0 || this.q === null) throw new BlockError(this.name, `has no grid for frame record ${frame}`);
    const at = this.need(12, frame);
    return [0, 4, 8].map((byte) => this.view.getInt32(at + byte, true));
  }

  /** Adds the stored differences and the shift to `q`. */
  readBody(frame, shift) {
    const planes = this.bytes[this.need(1, frame)];
    if (planes < 1 || planes > 4) throw new BlockError(this.name, `has ${planes} bytes a value in record ${frame}`);
    const size = 3 * this.vertexCount;
    const at = this.need(planes * size, frame);
    const { bytes, q, vertexCount } = this;
    for (let axis = 0; axis < 3; axis++) {
      const end = (axis + 1) * vertexCount;
      let running = shift[axis];
      for (let i = axis * vertexCount; i < end; i++) {
        let code = bytes[at + i];
        if (planes > 1) code |= bytes[at + size + i] << 8;
        if (planes > 2) code |= bytes[at + 2 * size + i] << 16;
        if (planes > 3) code |= bytes[at + 3 * size + i] << 24;
        running = (running + ((code >>> 1) ^ -(code & 1))) | 0;
        q[i] = (q[i] + running) | 0;
      }
    }
  }

  next(frame) {
    const shift = this.readHeader(frame);
    this.readBody(frame, shift);
    return { ...this.positions() };
  }

  /** The middle of the frame's box in double, and the vertices relative to it. */
  positions() {
    const { q, vertexCount, origin, step } = this;
    const center = [0, 0, 0];
    const half = [0, 0, 0];
    const local = new Float32Array(3 * vertexCount);
    for (let axis = 0; axis < 3; axis++) {
      const begin = axis * vertexCount;
      let least = q[begin];
      let most = q[begin];
      for (let i = begin; i < begin + vertexCount; i++) {
        if (q[i] < least) least = q[i];
        if (q[i] > most) most = q[i];
      }
      const middle = (origin[axis] + step * least + (origin[axis] + step * most)) / 2;
      center[axis] = middle;
      half[axis] = (step * (most - least)) / 2;
      for (let i = 0; i < vertexCount; i++) local[3 * i + axis] = origin[axis] + step * q[begin + i] - middle;
    }
    return { center, half, local };
  }
}

const pause = () => new Promise((resolve) => setTimeout(resolve, 0));

/** The positions of a recording. Frames become available in order; ask `complete` for all of them. */
export class FrameStore {
  /**
   * @param {Uint8Array} bytes frame records
   * @param {number} vertexCount
   * @param {number[]} times the frame of each record, ascending
   * @param {string} name of the block, for errors
   */
  constructor(bytes, vertexCount, times, name) {
    this.vertexCount = vertexCount;
    this.times = times;
    this.name = name;
    this.records = [];
    this.reader = new RecordReader(bytes, vertexCount, name);
    this.readNext();
    this.complete = null;
  }

  get count() {
    return this.times.length;
  }

  get available() {
    return this.records.length;
  }

  readNext() {
    const number = this.records.length;
    this.records.push({ number, ...this.reader.next(number) });
  }

  /** Reads all records, a slice at a time; a promise that fails when they are damaged. */
  readAll(progress = () => {}) {
    this.complete ??= this.readSlices(progress);
    return this.complete;
  }

  async readSlices(progress) {
    let until = performance.now() + SLICE_MS;
    while (this.available < this.count) {
      this.readNext();
      if (performance.now() < until) continue;
      progress(this);
      await pause();
      until = performance.now() + SLICE_MS;
    }
    if (this.reader.offset !== this.reader.bytes.length) throw new BlockError(this.name, 'is longer than its frames');
    this.reader = null;
  }

  record(i) {
    return this.records[Math.min(i, this.available - 1)];
  }

  /** @returns {number[]} in double */
  center(i) {
    return this.record(i).center;
  }

  /** Half the sides of the frame's box. */
  half(i) {
    return this.record(i).half;
  }

  /** @returns {Float32Array} */
  local(i) {
    return this.record(i).local;
  }

  /** The kept frame at or before a time, and how far the time is on the way to the next one. */
  locate(time) {
    const { times } = this;
    let low = 0;
    let high = times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    if (low === times.length - 1) return { i: low, fraction: 0 };
    const fraction = (time - times[low]) / (times[low + 1] - times[low]);
    return { i: low, fraction: Math.min(1, Math.max(0, fraction)) };
  }

  /** The middle of the box at any time: linear between kept frames. */
  centerAt(time) {
    const { i, fraction } = this.locate(time);
    const a = this.center(i);
    if (fraction === 0) return a;
    const b = this.center(i + 1);
    return a.map((value, axis) => value + fraction * (b[axis] - value));
  }

  /** One vertex at any time, in double. */
  vertexAt(vertex, time) {
    const { i, fraction } = this.locate(time);
    const at = (frame) => this.center(frame).map((value, axis) => value + this.local(frame)[3 * vertex + axis]);
    const a = at(i);
    if (fraction === 0) return a;
    const b = at(i + 1);
    return a.map((value, axis) => value + fraction * (b[axis] - value));
  }
}

const AT_REST = 2 ** -18; // of the longest side: below a step of the grid, and above what float32 rounds

const mixed = (a, b, share) => a.map((value, i) => value + share * (b[i] - value));

/** Positions before and after, two records a frame; what is shown lies `share` of the way from one to the other. */
export class PairedFrames extends FrameStore {
  constructor(...given) {
    super(...given);
    this.share = 0;
    this.mixtures = new Map();
    this.distances = new Map();
  }

  readNext() {
    const number = this.records.length;
    const [before, after] = [0, 1].map((side) => this.reader.next(2 * number + side));
    this.records.push({ number, before, after });
  }

  setShare(share) {
    if (share === this.share) return;
    this.share = share;
    this.mixtures.clear();
  }

  mix({ number, before, after }) {
    const { share } = this;
    if (share === 0 || share === 1) return { number: `${number} ${share}`, ...(share === 0 ? before : after) };
    const parts = ['center', 'half', 'local'].map((name) => [name, mixed(before[name], after[name], share)]);
    return { number: `${number} ${share}`, ...Object.fromEntries(parts) };
  }

  record(i) {
    const pair = super.record(i);
    if (!this.mixtures.has(pair.number)) {
      if (this.mixtures.size >= 4) this.mixtures.clear();
      this.mixtures.set(pair.number, this.mix(pair));
    }
    return this.mixtures.get(pair.number);
  }

  /** How far each vertex moved. @returns {Float32Array} */
  moves(i) {
    const { number, before, after } = super.record(i);
    if (this.distances.has(number)) return this.distances.get(number);
    const shift = after.center.map((value, axis) => value - before.center[axis]);
    const least = AT_REST * 2 * Math.max(...before.half);
    const found = new Float32Array(this.vertexCount);
    for (let v = 0; v < found.length; v++) {
      const along = shift.map((value, axis) => value + after.local[3 * v + axis] - before.local[3 * v + axis]);
      const distance = Math.hypot(...along);
      found[v] = distance > least ? distance : 0;
    }
    if (this.distances.size >= 4) this.distances.clear();
    this.distances.set(number, found);
    return found;
  }
}
