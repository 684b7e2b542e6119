/** The stages of a step, which of them a method has, and the colours of their charts. */

/** Has a summary times? `--reproducible` leaves them out. */
export const hasTimes = (summary) => summary.total_ms !== undefined;

export const STAGES = [
  { key: 'update', label: 'BVH update', colour: '#56b4e9' },
  { key: 'orientation', label: 'orientation', colour: '#e69f00' },
  { key: 'contour', label: 'contour', colour: '#f0e442' },
  { key: 'traversal', label: 'traversal', colour: '#0072b2' },
  { key: 'contact', label: 'contact', colour: '#d55e00' },
  { key: 'proof', label: 'proof', colour: '#cc79a7' },
];

export const OTHER = { key: 'other', label: 'other', colour: '#8a94a0' };

/** Does the method have the stage? The tool's table has an X where it does not. */
export function hasStage(method, key) {
  const contours = method === 'iccd' || method === 'iccd-published' || method === 'cones';
  const oriented = method !== 'none' && method !== 'brute' && !contours;
  if (key === 'contour') return contours;
  return key === 'orientation' || key === 'proof' ? oriented : true;
}

export function stagesOf(method) {
  return STAGES.filter(({ key }) => hasStage(method, key));
}

/** The part of an interval's total that belongs to no stage: checks of the input, and the work between stages. */
export function otherMilliseconds(ms) {
  return Math.max(
    0,
    STAGES.reduce((rest, { key }) => rest - ms[key], ms.total),
  );
}

/** Whether contacts of an interval may be missing, in words; components with the same guarantee are put together.
 *  Files of version 1 have an entry without a count for each component. */
export function guaranteeInWords(guarantee) {
  const counts = new Map();
  let components = 0;
  for (const { mode, reason, count = 1 } of guarantee) {
    const words = `${mode === 'all' ? 'none' : 'perhaps'}: ${reason}`;
    counts.set(words, (counts.get(words) ?? 0) + count);
    components += count;
  }
  const parts = [...counts];
  if (parts.length === 1) return parts[0][0];
  return parts.map(([words, count]) => `${count} of ${components} components, ${words}`).join('; ');
}
