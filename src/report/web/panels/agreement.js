/** In which intervals replays found the same contacts, and under which circumstances they ran. */
import { counted, integer, ranges } from './format.js';
import { extent, finder } from './intervalof.js';
import { nameOf } from './palette.js';

/** In which intervals a replay found other contacts than the first did, and how many both have. */
function disagreement(first, other, [begin, end]) {
  const contacts = [];
  const times = [];
  let common = 0;
  for (let frame = begin; frame < end; frame++) {
    const a = first(frame);
    const b = other(frame);
    if (!a || !b) continue;
    common++;
    if (a.vf !== b.vf || a.ee !== b.ee) contacts.push(frame);
    else if (a.earliest_toi !== b.earliest_toi) times.push(frame);
  }
  return { contacts, times, common };
}

const of = (frames, common) =>
  `in ${integer(frames.length)} of ${counted(common, 'interval')} (frames ${ranges(frames)})`;

/** [grade, sentence] of each replay after the first; those that agree share one. */
export function agreement(report) {
  const span = extent(report);
  const finders = report.summaries.map(({ summary }) => finder(summary));
  const agreeing = new Map();
  const sentences = [];
  for (let i = 1; i < finders.length; i++) {
    const { contacts, times, common } = disagreement(finders[0], finders[i], span);
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

/* What changes contacts, then what changes times only. */
const GRAVE = ['model', 'recording', 'frames', 'mode', 'least separation'];

/** what -> its value in one replay. */
function circumstances({ provenance, summary, intervals }) {
  const { machine } = provenance;
  const input = (i) =>
    provenance.inputs?.[i] ? `${provenance.inputs[i].name} ${provenance.inputs[i].fnv1a64}` : 'unknown';
  const content = (i) => provenance.inputs?.[i]?.fnv1a64 ?? 'unknown';
  const span =
    intervals.length > 0 ? `${intervals[0].frame} to ${intervals[intervals.length - 1].frame + 1}` : 'none';
  return {
    model: [content(0), input(0)],
    recording: [content(1), input(1)],
    frames: [span],
    mode: [summary.mode],
    'least separation': [String(summary.min_separation)],
    machine: [
      `${machine.processor}, ${counted(machine.processors, 'processor')}, ` +
        `${machine.system} ${machine.release}`,
    ],
    threads: [String(provenance.threads)],
    compiler: [`${provenance.compiler} ${provenance.flags}`],
    commit: [provenance.commit],
    'vector instructions': [summary.simd],
  };
}

/** [grade, sentence] of each circumstance that is not the same for all. */
export function differences(report) {
  const all = report.summaries.map(({ summary }) => circumstances(summary));
  return Object.keys(all[0])
    .filter((what) => all.some((one) => one[what][0] !== all[0][what][0]))
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
      const grave = GRAVE.includes(what);
      return [
        grave ? 'alarm' : 'warn',
        `Not the same ${what}: ${values}. ` +
          (grave ? 'Neither contacts nor times can be compared directly.' : 'Compare times with care.'),
      ];
    });
}
