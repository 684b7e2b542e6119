/** Events: which is the worse of two, and what they are called. */

/** A part that lies in itself without a pair or a contact: some other part cuts it, and what that buries is nearest to itself. */
const onlyInItself = ({ a, b, pairs, contacts }) => a === b && pairs === 0 && contacts === 0;

/** Has one part something within the other? */
export const isWithin = ({ kinds, depth }) => depth > 0 || kinds.includes('crossing') || kinds.includes('same_solid');

/** What is within another part comes before what only touches it, and that before contacts alone; what lies in itself alone is last. */
function rankOf(event) {
  if (onlyInItself(event)) return 3;
  if (isWithin(event)) return 0;
  return event.pairs > 0 ? 1 : 2;
}

/** The tool's order (event_order.c): by rank, then by depth, length, pairs and contacts. */
export function worseThan(a, b) {
  if (rankOf(a) !== rankOf(b)) return rankOf(a) < rankOf(b);
  for (const key of ['depth', 'length', 'pairs', 'contacts']) if (a[key] !== b[key]) return a[key] > b[key];
  return false;
}

/** What an event is, in a word, that which weighs most, and in what state its mark is drawn. */
export function kindOf({ kinds, pairs, depth }) {
  if (kinds.includes('crossing')) return ['penetrating', 'crossing'];
  if (depth > 0) return ['penetrating', pairs > 0 ? 'overlapping' : 'inside'];
  if (kinds.includes('same_solid')) return ['penetrating', 'copies of one solid'];
  return pairs > 0 ? ['unknown', 'touching'] : ['contact', 'contact only'];
}

/** The parts of an event. */
export const whoOf = ({ a, b }) => (a === b ? `${a} × itself` : `${a} × ${b}`);
