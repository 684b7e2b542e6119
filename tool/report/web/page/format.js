/** Numbers as the page writes them: counts in full, measurements with enough digits. */

const THIN = '\u202f';

const group = (digits) => digits.replace(/\B(?=(\d{3})+(?!\d))/g, THIN);

/** A count, never rounded. */
export function integer(value) {
  return group(String(value));
}

/** A number with this many decimals; a value that they would round to 0 keeps two significant digits. */
export function decimal(value, decimals) {
  if (value !== 0 && Math.abs(value) < 10 ** -decimals) return significant(value, 2);
  const [whole, rest] = value.toFixed(decimals).split('.');
  return rest === undefined ? group(whole) : `${group(whole)}.${rest}`;
}

export function significant(value, digits) {
  return String(Number(value.toPrecision(digits)));
}

const METRES = { um: 1e-6, mm: 1e-3, cm: 1e-2, dm: 0.1, m: 1, km: 1e3 };
const STEPS = [['km', 1e3], ['m', 1], ['mm', 1e-3]];

/** A length with its unit, three digits of it; metric ones in um, mm, m or km, whichever suits. unit null: nobody knows it. */
export function lengthText(value, unit) {
  if (unit === null) return significant(value, 3);
  if (METRES[unit] === undefined) return `${significant(value, 3)} ${unit}`;
  const metres = value * METRES[unit];
  const [name, scale] = STEPS.find(([, step]) => Math.abs(metres) >= 0.9995 * step) ?? ['um', 1e-6];
  return `${significant(metres / scale, 3)} ${name}`;
}

export function milliseconds(value) {
  return value === 0 ? '0' : decimal(value, 3);
}

export function percent(share, decimals = 1) {
  return `${decimal(100 * share, decimals)}${THIN}%`;
}

/** A time in frames, with decimals between frames only. */
export function moment(time) {
  return Number.isInteger(time) ? String(time) : time.toFixed(2);
}

/** "1 contact", "2 contacts". */
export function counted(count, one, many = `${one}s`) {
  return `${integer(count)} ${count === 1 ? one : many}`;
}

/** "3, 7 to 9 and 12" for ascending numbers; after `most` ranges how many follow. */
export function ranges(numbers, most = 12) {
  const parts = [];
  for (let i = 0; i < numbers.length; i++) {
    const from = numbers[i];
    while (i + 1 < numbers.length && numbers[i + 1] === numbers[i] + 1) i++;
    parts.push(from === numbers[i] ? `${from}` : `${from} to ${numbers[i]}`);
  }
  if (parts.length > most) return `${parts.slice(0, most).join(', ')} and ${parts.length - most} more ranges`;
  if (parts.length < 2) return parts.join('');
  return `${parts.slice(0, -1).join(', ')} and ${parts[parts.length - 1]}`;
}

/** Decimals that tell positions apart: six digits of the largest coordinate. */
export function positionDecimals(coordinates, unit) {
  let largest = 0;
  for (const value of coordinates) largest = Math.max(largest, Math.abs(value));
  return Math.min(12, Math.max(0, 5 - Math.floor(Math.log10(largest * unit || 1))));
}

/** "x, y, z"; what rounds to nothing has no sign. */
export function coordinates(point, decimals) {
  return point.map((value) => value.toFixed(decimals).replace(/^-(?=[0.]+$)/, '')).join(', ');
}
