/** Events: which is the worse of two, and what they are called. */

/** A part that lies in itself without a pair or a contact: some other part cuts it, and what that buries is nearest to itself. */
const onlyInItself = ({ a, b, pairs, contacts }) => a === b && pairs === 0 && contacts === 0;

/** As the tracker orders groups: by depth, then by length, then by pairs, then by contacts; what lies in itself alone comes last. */
export function worseThan(a, b) {
  if (onlyInItself(a) !== onlyInItself(b)) return onlyInItself(b);
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
