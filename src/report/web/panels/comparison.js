/** What several replays have in common and where they differ. */
import { element, heading } from './dom.js';
import { counted, decimal, integer, ranges } from './format.js';
import { extent, finder } from './intervalof.js';
import { lineOf, nameOf } from './palette.js';

/** Frames of the intervals in which a replay found other contacts than the first did, and how many both have. */
function disagreement(first, other, [begin, end]) {
  const differing = [];
  const times = [];
  let common = 0;
  for (let frame = begin; frame < end; frame++) {
    const a = first(frame);
    const b = other(frame);
    if (!a || !b) continue;
    common++;
    if (a.vf !== b.vf || a.ee !== b.ee) differing.push(frame);
    else if (a.earliest_toi !== b.earliest_toi) times.push(frame);
  }
  return { differing, times, common };
}

function contactWords(report) {
  const span = extent(report);
  const finders = report.summaries.map(({ summary }) => finder(summary));
  const lines = [];
  for (let i = 1; i < finders.length; i++) {
    const { differing, times, common } = disagreement(finders[0], finders[i], span);
    const who = nameOf(report, i);
    if (common === 0) lines.push(['warn', `${who} has no interval in common with the first.`]);
    else if (differing.length > 0)
      lines.push(['warn', `${who} found other contacts than the first in ${integer(differing.length)} of ${counted(common, 'interval')}: frames ${ranges(differing)}.`]);
    else if (times.length > 0)
      lines.push(['warn', `${who} found as many contacts as the first in all ${counted(common, 'interval')}, but with another earliest time in ${counted(times.length, 'interval')}: frames ${ranges(times)}.`]);
    else lines.push(['', `${who}: in all ${counted(common, 'interval')} as many VF and EE contacts as the first, and the same earliest times.`]);
  }
  return lines;
}

/** [what, value of each] of what should be the same where times or contacts are compared. */
function circumstances({ provenance, summary, intervals }) {
  const { machine } = provenance;
  const span = intervals.length > 0 ? `${intervals[0].frame} to ${intervals[intervals.length - 1].frame + 1}` : 'none';
  return {
    'model': provenance.inputs?.[0]?.fnv1a64 ?? 'unknown',
    'recording': provenance.inputs?.[1]?.fnv1a64 ?? 'unknown',
    'frames': span,
    'mode': summary.mode,
    'least separation': String(summary.min_separation),
    'machine': `${machine.processor} (${machine.processors}), ${machine.system}`,
    'threads': String(provenance.threads),
    'compiler': `${provenance.compiler} ${provenance.flags}`,
    'commit': provenance.commit,
    'vector instructions': summary.simd,
  };
}

const CHANGES_CONTACTS = ['model', 'recording', 'frames', 'mode', 'least separation'];

function differences(report) {
  const all = report.summaries.map(({ summary }) => circumstances(summary));
  return Object.keys(all[0]).filter((what) => all.some((one) => one[what] !== all[0][what])).map((what) => {
    const values = all.map((one, index) => `${nameOf(report, index)}: ${one[what]}`).join('; ');
    const grave = CHANGES_CONTACTS.includes(what);
    return [grave ? 'alarm' : 'warn', `The ${what} ${what.endsWith('s') ? 'differ' : 'differs'} (${values}). ${grave ? 'Contacts and times cannot be compared directly.' : 'Times cannot be compared directly.'}`];
  });
}

const note = ([grade, text]) => element('p', { class: `note ${grade}`, text });

function overview(report) {
  const head = element('tr');
  const names = ['replay', 'method', 'intervals', 'with contact', 'VF', 'EE', 'mean total', 'to the first'];
  names.forEach((text, i) => head.append(element('th', { scope: 'col', text, class: i > 1 ? 'number' : undefined })));
  const body = element('tbody');
  const base = report.summaries[0].summary.summary.total_ms.mean;
  report.summaries.forEach(({ summary: { summary } }, index) => {
    const number = (text, value) => element('td', { class: 'number', text, 'data-value': value, title: value });
    const ratio = summary.total_ms.mean / base;
    body.append(element('tr', {}, element('th', { scope: 'row' }, lineOf(index), ` ${nameOf(report, index)}`), element('td', { text: summary.method }),
      ...['intervals', 'intervals_with_contact', 'vf', 'ee'].map((key) => number(integer(summary[key]), summary[key])),
      number(`${decimal(summary.total_ms.mean, 3)} ms`, summary.total_ms.mean),
      Number.isFinite(ratio) ? number(`${decimal(ratio, 2)} ×`, ratio) : number('–', '')));
  });
  return element('div', { class: 'scroll' }, element('table', { 'aria-label': 'Comparison' }, element('thead', {}, head), body));
}

export function create(container, report) {
  container.hidden = report.kind !== 'compare' || report.summaries.length === 0;
  if (container.hidden) return;
  const words = [...differences(report), ...contactWords(report)];
  container.append(heading('Comparison', element('span', { class: 'quiet', text: counted(report.summaries.length, 'replay') })), overview(report));
  if (words.length > 0) container.append(element('div', { class: 'comparison-notes' }, ...words.map(note)));
}
