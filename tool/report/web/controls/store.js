/** The state of the page, and the functions to call when it changes. */

/**
 * @typedef {object} State
 * @property {number} time in frames: 12.5 is halfway from frame 12 to 13
 * @property {boolean} playing
 * @property {number} speed frames a second
 * @property {boolean} loop
 * @property {'plain'|'charge'|'equalized'|'region'|'orientation'|'heat'|'displacement'} colour
 * @property {number} share of the way from before, 0, to after, 1, on pages that have both
 * @property {boolean} answers fill what intersects, and draw the curves
 * @property {number|null} event the number of the event last gone to
 * @property {boolean} contacts mark the contacts of the interval
 * @property {boolean} trail mark those of the intervals before, fading
 * @property {boolean} through show marks that the surface hides, faintly
 * @property {boolean} points detector points
 * @property {boolean} cuts edges between regions
 * @property {boolean} edges all edges of the mesh
 * @property {boolean} scenery
 * @property {number|null} selected a contact's number in the report
 * @property {number|null} triangle the one last clicked
 * @property {'light'|'dark'} theme
 * @property {'z'|'y'} up which axis points up in the view
 */

/** @param {State} initial */
export function createStore(initial) {
  const state = { ...initial };
  /** @type {{keys: Set<string>, listener: Function}[]} */
  const listeners = [];
  return {
    get: () => state,

    /** Sets the values that differ, then calls each listener of one of these keys once. */
    set(changes) {
      const changed = Object.keys(changes).filter((key) => !Object.is(state[key], changes[key]));
      if (changed.length === 0) return;
      Object.assign(state, changes);
      for (const { keys, listener } of [...listeners]) {
        if (changed.some((key) => keys.has(key))) listener(state, changed);
      }
    },

    /** Adds listener(state, changedKeys); returns a function that removes it. */
    on(keys, listener) {
      const entry = { keys: new Set(keys), listener };
      listeners.push(entry);
      return () => listeners.splice(listeners.indexOf(entry), 1);
    },
  };
}
