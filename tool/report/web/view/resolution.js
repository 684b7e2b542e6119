/** Chooses how many pixels are drawn: all of the screen at rest, fewer in motion if all would be too slow. */

const LEAST = 0.7; // pixels of the buffer for one of the page
const SLOW_MS = 30;
const QUICK_MS = 12;
const REST_MS = 160;
/** Opaque, so that the page need not blend it; preserved, so that it can be printed. */
const OPTIONS = { alpha: false, stencil: false, preserveDrawingBuffer: true };

/** Without a graphics processor each pixel costs time, and several samples per pixel cost even more. */
function inSoftware(context) {
  const details = context.getExtension('WEBGL_debug_renderer_info');
  const name = context.getParameter(details?.UNMASKED_RENDERER_WEBGL ?? context.RENDERER);
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(String(name));
}

/** A canvas and its context, which smooths edges where that costs little. */
export function createContext() {
  const make = (antialias) => {
    const canvas = document.createElement('canvas');
    return { canvas, context: canvas.getContext('webgl2', { ...OPTIONS, antialias }) };
  };
  const plain = make(false); // first the one for software, where making a context takes long
  if (plain.context === null) throw new Error('WebGL 2 is not available');
  if (inSoftware(plain.context)) return { ...plain, software: true };
  plain.context.getExtension('WEBGL_lose_context')?.loseContext();
  const smooth = make(true);
  if (smooth.context === null) throw new Error('WebGL 2 is not available');
  return { ...smooth, software: false };
}

export class Resolution {
  constructor(viewer, software) {
    this.viewer = viewer;
    this.software = software;
    this.share = software ? 0.5 : 1; // of the full resolution, in motion
    this.inMotion = false;
    this.rest = null;
    this.last = 0;
    this.mean = 0;
    this.ratio = 1;
  }

  /** The resolution at rest. Software then draws four pixels for one to smooth edges, and has the time. */
  get full() {
    const density = window.devicePixelRatio || 1;
    return this.software ? Math.max(2, Math.min(density, 3)) : Math.min(density, 3);
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

  /** Called after each picture: the time from one to the next shows what the machine can do. */
  drawn() {
    if (!this.inMotion) return;
    const now = performance.now();
    const elapsed = now - this.last;
    const known = this.last > 0 && elapsed < 400;
    this.last = now;
    if (!known) return;
    this.mean = this.mean === 0 ? elapsed : 0.8 * this.mean + 0.2 * elapsed;
    const next = this.mean > SLOW_MS ? this.share * 0.85 : this.mean < QUICK_MS ? this.share * 1.1 : this.share;
    const most = this.software ? 0.5 : 1;
    const share = Math.min(most, Math.max(LEAST / this.full, next));
    if (Math.abs(share - this.share) < 0.01) return;
    this.share = share;
    this.mean = 0;
    this.apply();
  }
}
