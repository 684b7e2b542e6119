/** In which intervals replays found the same contacts, and under which circumstances they ran. */
import { counted, integer, ranges } from '../page/format.js';
import { finder, lastFrameOf } from '../page/intervals.js';
import { nameOf } from '../page/names.js';

/** In which of its intervals a replay found other contacts than the first did, and how many both have. */
function disagreement(first, intervals) {
  const contacts = [];
  const times = [];
  let common = 0;
  for (const own of intervals) {
    const other = first(own.frame);
    if (!other) continue;
    common++;
    if (other.vf !== own.vf || other.ee !== own.ee) contacts.push(own.frame);
    else if (other.earliest_toi !== own.earliest_toi) times.push(own.frame);
  }
  return { contacts, times, common };
}

const of = (frames, common) =>
  `in ${integer(frames.length)} of ${counted(common, 'interval')} (frames ${ranges(frames)})`;

/** [grade, sentence] of each replay after the first; those that agree share one. */
export function agreement(report) {
  const first = finder(report.summaries[0].summary);
  const agreeing = new Map();
  const sentences = [];
  for (let i = 1; i < report.summaries.length; i++) {
    const { contacts, times, common } = disagreement(first, report.summaries[i].summary.intervals);
    const who = nameOf(report, i);
    if (common === 0) sentences.push(['warn', `${who} has no interval in common with ${nameOf(report, 0)}.`]);
    else if (contacts.length > 0)
      sentences.push([
        'warn',
        `${who}: other numbers of contacts than ${nameOf(report, 0)} ${of(contacts, common)}.`,
      ]);
    else if (times.length > 0)
      sentences.push([
        'warn',
        `${who}: as many contacts as ${nameOf(report, 0)}, but another earliest time ${of(times, common)}.`,
      ]);
    else agreeing.set(common, [...(agreeing.get(common) ?? []), who]);
  }
  for (const [common, names] of agreeing)
    sentences.unshift([
      'good',
      `Contacts agree: in all ${counted(common, 'common interval')} ${names.join(', ')} found as many ` +
        `VF and EE contacts as ${nameOf(report, 0)}, at the same earliest times.`,
    ]);
  return sentences;
}

/* What differs where a scene was mended between the runs; options that change contacts; the rest changes times only. */
const MENDED = ['model', 'recording'];
const GRAVE = ['frames', 'mode', 'least separation'];

function consequenceOf(what) {
  if (MENDED.includes(what)) return ['warn', 'Numbers of contacts and times are of different motions.'];
  if (GRAVE.includes(what)) return ['alarm', 'Neither contacts nor times can be compared directly.'];
  return ['warn', 'Compare times with care.'];
}

/** The circumstances of a replay and their values. */
function circumstances(run) {
  const { provenance, summary, intervals } = run;
  const { machine } = provenance;
  const input = (i) =>
    provenance.inputs?.[i] ? `${provenance.inputs[i].name} ${provenance.inputs[i].fnv1a64}` : 'unknown';
  const content = (i) => provenance.inputs?.[i]?.fnv1a64 ?? 'unknown';
  const span =
    intervals.length > 0 ? `${intervals[0].frame} to ${lastFrameOf(run)}` : 'none';
  return {
    model: [content(0), input(0)],
    recording: [content(1), input(1)],
    frames: [span],
    mode: [summary.mode],
    'least separation': [String(summary.min_separation)],
    machine: [
      machine
        ? `${machine.processor}, ${counted(machine.processors, 'processor')}, ` +
          `${machine.system} ${machine.release}`
        : 'not said',
    ],
    threads: [String(provenance.threads ?? 'not said')],
    compiler: [`${provenance.compiler} ${provenance.flags}`],
    commit: [provenance.commit],
    'vector instructions': [summary.simd ?? 'not said'],
  };
}

/** Do values differ? Recordings are compared by the frames that were read, not by others. */
function differs(all, what) {
  const comparable = (a, b) => what !== 'recording' || a.frames[0] === b.frames[0];
  return all.some((a) => all.some((b) => comparable(a, b) && a[what][0] !== b[what][0]));
}

/** [grade, sentence] of each circumstance that is not the same for all. */
export function differences(report) {
  const all = report.summaries.map(({ summary }) => circumstances(summary));
  return Object.keys(all[0])
    .filter((what) => differs(all, what))
    .map((what) => {
      const groups = new Map();
      all.forEach((one, index) => {
        const [key, words = key] = one[what];
        const group = groups.get(key) ?? { words, names: [] };
        group.names.push(nameOf(report, index));
        groups.set(key, group);
      });
      const values = [...groups.values()]
        .map(({ words, names }) => `${words} (${names.join(', ')})`)
        .join('; ');
      const [grade, consequence] = consequenceOf(what);
      return [grade, `Not the same ${what}: ${values}. ${consequence}`];
    });
}
