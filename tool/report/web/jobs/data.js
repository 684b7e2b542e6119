/** The jobs of the page: its data blocks as columns, and the orders and choices of rows. */
import { BlockError, readArray, readDocument } from '../data/decode.js';

/** The columns of numbers that a page may have. */
const NUMBERS = ['crossing_frames', 'frames', 'events', 'depth', 'pairs', 'seconds'];

/** What a reader should look at first; jobs that fail by the rules of their run come right behind those that failed. */
const WORST_FIRST = ['failed', 'found', 'crossing', 'inside', 'touching', 'duplicate', 'missing', 'clean'];

/** Texts end with a 0 each. */
function textsOf(bytes, count, name) {
  const texts = new TextDecoder('utf-8', { ignoreBOM: true }).decode(bytes).split('\0');
  if (texts.length !== count + 1)
    throw new BlockError(name, `has ${texts.length - 1} texts where ${count} belong`);
  texts.pop();
  return texts;
}

function checkOutcomes(outcome, outcomes) {
  if (outcomes.some((name) => !WORST_FIRST.includes(name)))
    throw new BlockError('cscd-report', `has outcomes that this page does not know: ${outcomes.join(', ')}`);
  for (let i = 0; i < outcome.length; i++)
    if (outcome[i] >= outcomes.length) throw new BlockError('outcome', `has ${outcome[i]} at ${i}`);
}

/**
 * @returns {Promise<object>} of each job outcome (an index of outcomes), found (1: it fails by the rules of its run), names, answers
 *   and links; numbers: its columns by name, NaN where nothing is known
 */
export async function readJobs() {
  const { title, generator, list, missing, outcomes, arrays } = readDocument();
  const entries = await Promise.all(arrays.map(async (entry) => [entry.name, await readArray(entry)]));
  const blocks = Object.fromEntries(entries);
  for (const name of ['outcome', 'found', 'names', 'answers', 'links'])
    if (blocks[name] === undefined) throw new BlockError(name, 'is missing');
  const count = blocks.outcome.length;
  const numbers = Object.fromEntries(NUMBERS.filter((name) => name in blocks).map((name) => [name, blocks[name]]));
  for (const [name, values] of Object.entries({ found: blocks.found, ...numbers }))
    if (values.length !== count) throw new BlockError(name, `has ${values.length} numbers where ${count} belong`);
  checkOutcomes(blocks.outcome, outcomes);
  const [names, answers, links] = ['names', 'answers', 'links'].map((name) => textsOf(blocks[name], count, name));
  const { outcome, found } = blocks;
  return { title, generator, list, missing, outcomes, count, outcome, found, names, answers, links, numbers };
}

/** How many jobs have each outcome, by name, and `found`. */
export function countOutcomes({ outcomes, outcome, found, count }) {
  const counts = Object.fromEntries([...outcomes, 'found'].map((name) => [name, 0]));
  for (let i = 0; i < count; i++) {
    counts[outcomes[outcome[i]]]++;
    counts.found += found[i];
  }
  return counts;
}

/** The greater first, what is not known last; 0: equal. */
function compareNumbers(a, b, descending) {
  if (a === b) return 0;
  if (Number.isNaN(a) || Number.isNaN(b)) return Number(Number.isNaN(a)) - Number(Number.isNaN(b));
  return descending ? b - a : a - b;
}

const allOf = ({ count }) => Uint32Array.from({ length: count }, (_, i) => i);

/** All jobs, the worst first: by outcome, then by depth, frames and pairs. */
function worstFirst(jobs) {
  const { outcomes, outcome, found, numbers } = jobs;
  const places = outcomes.map((name) => WORST_FIRST.indexOf(name));
  const ruled = WORST_FIRST.indexOf('found');
  const grade = Uint8Array.from(outcome, (o, i) => (found[i] && places[o] > ruled ? ruled : places[o]));
  const keys = ['depth', 'crossing_frames', 'pairs'].map((name) => numbers[name]).filter(Boolean);
  return allOf(jobs).sort((a, b) => {
    let order = grade[a] - grade[b];
    for (let k = 0; k < keys.length && order === 0; k++) order = compareNumbers(keys[k][a], keys[k][b], true);
    return order || a - b;
  });
}

/** Sorts jobs by a column; what is equal there stays in the order of the worst. */
export function createOrders(jobs) {
  const worst = worstFirst(jobs);
  const rank = new Uint32Array(jobs.count);
  worst.forEach((job, i) => {
    rank[job] = i;
  });
  const compareNames = (a, b) => (jobs.names[a] < jobs.names[b] ? -1 : Number(jobs.names[a] > jobs.names[b]));
  return (column, descending) => {
    const values = jobs.numbers[column];
    if (column === 'outcome') return descending ? worst : worst.slice().reverse();
    if (column === 'number') return descending ? allOf(jobs).reverse() : allOf(jobs);
    if (column === 'name')
      return allOf(jobs).sort((a, b) => (descending ? compareNames(b, a) : compareNames(a, b)) || rank[a] - rank[b]);
    return allOf(jobs).sort((a, b) => compareNumbers(values[a], values[b], descending) || rank[a] - rank[b]);
  };
}

/** Chooses jobs by outcome and by words, all of which must be in the name, the answer or the reason. */
export function createFilter(jobs) {
  let lower = null;
  const texts = () => {
    lower ??= jobs.names.map((name, i) => `${name}\n${jobs.answers[i]}`.toLowerCase());
    return lower;
  };
  return (order, kind, text) => {
    const words = text.toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = jobs.outcomes.indexOf(kind);
    const fits = (job) =>
      (kind === 'all' || (kind === 'found' ? jobs.found[job] === 1 : jobs.outcome[job] === wanted)) &&
      words.every((word) => texts()[job].includes(word));
    return kind === 'all' && words.length === 0 ? order : order.filter(fits);
  };
}
