/** Events: which is the worse of two, and what they are called. */

/** As the tracker orders groups: by depth, then by length, then by pairs, then by contacts. */
export function worseThan(a, b) {
  for (const key of ['depth', 'length', 'pairs', 'contacts']) if (a[key] !== b[key]) return a[key] > b[key];
  return false;
}

/** The parts of an event. */
export const whoOf = ({ a, b }) => (a === b ? `${a} × itself` : `${a} × ${b}`);
