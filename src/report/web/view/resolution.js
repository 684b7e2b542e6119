/** How many pixels are drawn: all of the screen's at rest, fewer in motion where that is too slow. */

const LEAST = 0.5;
const SLOW_MS = 24; // less than 40 frames a second
const QUICK_MS = 14;
const REST_MS = 160;

export class Resolution {
  constructor(viewer) {
    this.viewer = viewer;
    this.share = 1; // of the full resolution, in motion
    this.inMotion = false;
    this.rest = null;
    this.last = 0;
    this.mean = 0;
    this.ratio = 1;
  }

  get full() {
    return Math.min(window.devicePixelRatio || 1, 3);
  }

  apply() {
    const { renderer, size } = this.viewer;
    this.ratio = this.inMotion ? Math.max(LEAST, this.full * this.share) : this.full;
    renderer.setPixelRatio(this.ratio);
    renderer.setSize(size.width, size.height, false);
  }

  moving() {
    if (!this.inMotion) {
      this.inMotion = true;
      this.last = 0;
      if (this.share < 1) this.apply();
    }
    clearTimeout(this.rest);
    this.rest = setTimeout(() => this.stop(), REST_MS);
  }

  stop() {
    this.inMotion = false;
    if (this.share < 1) {
      this.apply();
      this.viewer.invalidate();
    }
  }

  /** After each picture: the time from one to the next tells what the machine can do. */
  drawn() {
    if (!this.inMotion) return;
    const now = performance.now();
    const elapsed = now - this.last;
    const known = this.last > 0 && elapsed < 400;
    this.last = now;
    if (!known) return;
    this.mean = this.mean === 0 ? elapsed : 0.8 * this.mean + 0.2 * elapsed;
    const next = this.mean > SLOW_MS ? this.share * 0.85 : this.mean < QUICK_MS ? this.share * 1.1 : this.share;
    const share = Math.min(1, Math.max(LEAST / this.full, next));
    if (Math.abs(share - this.share) < 0.01) return;
    this.share = share;
    this.mean = 0;
    this.apply();
  }
}
