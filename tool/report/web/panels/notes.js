/** Notes on what is missing or was lost, which a reader must know before trusting the rest. */
import { element } from '../page/dom.js';
import { counted, integer, ranges } from '../page/format.js';
import { nameOf } from '../page/names.js';

/** [grade, what, more] each. */
function notesOfRun(summary, intervals) {
  const notes = [];
  if (!summary.complete)
    notes.push([
      'warn',
      `stopped early: ${summary.stopped_by ?? 'no reason is given'}`,
      `What is here ends after ${counted(summary.intervals, 'interval')}.`,
    ]);
  if (/published$/.test(summary.method))
    notes.push([
      'warn',
      `method ${summary.method} loses contacts`,
      'It culls as published, for comparison only.',
    ]);
  else if (summary.intervals_complete < summary.intervals) {
    notes.push([
      '',
      'not every contact is promised',
      `In ${integer(summary.intervals - summary.intervals_complete)} of ` +
        `${counted(summary.intervals, 'interval')} later contacts may be missing (mode ${summary.mode}).`,
    ]);
  }
  if (summary.contradictions > 0) {
    notes.push([
      'alarm',
      counted(summary.contradictions, 'contradiction'),
      'Intervals that start free of intersections and end with one, without a contact: contacts were lost.',
    ]);
  }
  if (summary.unknown > 0 || (summary.frames_checked === 0 && intervals.length > 0))
    notes.push([
      '',
      'frames were not checked',
      'Whether the mesh intersects itself at the start of an interval is not known.',
    ]);
  if (summary.bounded > 0) {
    notes.push([
      '',
      `${counted(summary.bounded, 'contact')} with a safe bound only`,
      'Their times of impact may be early, and the pairs may stay farther apart than the least separation.',
    ]);
  }
  return notes;
}

/** Intervals with fewer contacts in the page than were found. */
function cappedIntervals(scene, intervals) {
  return intervals
    .filter(({ frame, vf, ee }) => {
      const [begin, end] = scene.contacts.range(frame);
      return end - begin < vf + ee;
    })
    .map(({ frame }) => frame);
}

/** Of long recordings every so many frames are drawn, and the table has all. */
function notesOfUntangled({ scene, untangled }) {
  if (untangled === null || scene.numbers.length === untangled.frames.length) return [];
  const drawn = `${integer(scene.numbers.length)} of ${integer(untangled.frames.length)}`;
  return [['', 'not every frame is drawn', `${drawn} are, with straight lines between them. The table is of every frame.`]];
}

function notesOfScene(scene, intervals) {
  const notes = [];
  const all = scene.numbers.length;
  if (scene.frames.length < all) {
    notes.push([
      '',
      'not every frame is drawn',
      `${integer(scene.frames.length)} of ${integer(all)} are, with straight lines between them. ` +
        'Contacts, tables and charts are of every interval; contacts may lie beside the surface drawn.',
    ]);
  }
  const info = scene.contactsInfo;
  if (info && info.kept < info.found) {
    const frames = cappedIntervals(scene, intervals);
    notes.push([
      '',
      'not every contact is in this page',
      `${integer(info.kept)} of ${integer(info.found)} are, the earliest of each interval: at most ` +
        `${integer(info.interval_limit)}, and fewer where later ones need their share of the ` +
        `${integer(info.limit)} that a page has room for. ` +
        `Fewer than found in ${counted(frames.length, 'interval')} (${ranges(frames)}).`,
    ]);
  }
  return notes;
}

const capitalized = (text) => text.charAt(0).toUpperCase() + text.slice(1);

function show(container, [grade, what, more], who) {
  const title = who ? `${who}: ${what}. ` : `${capitalized(what)}. `;
  container.append(element('p', { class: `note ${grade}` }, element('strong', { text: title }), more));
}

export function create(container, report) {
  report.summaries.forEach(({ summary }, index) => {
    const who = report.summaries.length > 1 ? nameOf(report, index) : '';
    for (const note of notesOfRun(summary.summary, summary.intervals)) show(container, note, who);
  });
  if (!report.scene) return;
  const intervals = report.summaries[0]?.summary.intervals ?? [];
  for (const note of [...notesOfUntangled(report), ...notesOfScene(report.scene, intervals)]) show(container, note, '');
}
