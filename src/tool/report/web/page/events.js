/** Events: which is the worse of two, and what they are called. */

/** As the tracker orders groups: by depth, then by length, then by pairs, then by contacts. */
export function worseThan(a, b) {
  for (const key of ['depth', 'length', 'pairs', 'contacts']) if (a[key] !== b[key]) return a[key] > b[key];
  return false;
}

/** What an event is, in a word, and in what state its mark is drawn. */
export function kindOf({ kinds, pairs, depth }) {
  if (kinds.some((kind) => kind !== 'touching') || (pairs === 0 && depth > 0)) return ['penetrating', 'intersecting'];
  return pairs > 0 ? ['unknown', 'touching'] : ['contact', 'contact only'];
}

/** The parts of an event. */
export const whoOf = ({ a, b }) => (a === b ? `${a} × itself` : `${a} × ${b}`);
