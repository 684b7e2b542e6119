/** Words for the outcomes of jobs. */
import { counted, integer } from '../page/format.js';

/** Of a row, and of a choice of rows. */
export const OUTCOME_NAME = {
  failed: 'failed',
  crossing: 'intersections',
  touching: 'only touching',
  inside: 'shared space',
  duplicate: 'only duplicates',
  missing: 'not done',
  clean: 'clean',
};

/** The first line: "100 jobs: 90 clean, 8 with intersections, 2 failed". */
export function answerOf(count, counts) {
  const parts = [`${integer(counts.clean)} clean`];
  for (const [outcome, words] of [
    ['crossing', 'with intersections'],
    ['touching', 'only touching'],
    ['inside', 'with parts that share space'],
    ['duplicate', 'only with duplicates'],
    ['failed', 'failed'],
    ['missing', 'not done'],
  ])
    if (counts[outcome] > 0) parts.push(`${integer(counts[outcome])} ${words}`);
  return `${counted(count, 'job')}: ${parts.join(', ')}`;
}

/** A path as a link; null where its name cannot be told. Every byte but letters, digits and a few signs is escaped. */
export function hrefOf(link) {
  if (link === '' || link.includes('\ufffd')) return null;
  return link.split('/').map(encodeURIComponent).join('/');
}
