/** What a reader must know before trusting the rest: what is missing, and what was lost. */
import { element } from './dom.js';
import { counted, integer, ranges } from './format.js';
import { nameOf } from './palette.js';

function notesOfRun(summary, intervals, who) {
  const notes = [];
  if (!summary.complete)
    notes.push([
      'warn',
      `${who}stopped early`,
      `${summary.stopped_by}. What is here ends after ${counted(summary.intervals, 'interval')}.`,
    ]);
  if (/published$/.test(summary.method))
    notes.push([
      'warn',
      `${who}method ${summary.method} loses contacts`,
      'It culls as published, for comparison only.',
    ]);
  else if (summary.intervals_complete < summary.intervals) {
    notes.push([
      '',
      `${who}not every contact is promised`,
      `In ${integer(summary.intervals - summary.intervals_complete)} of ` +
        `${counted(summary.intervals, 'interval')} later contacts may be missing (mode ${summary.mode}).`,
    ]);
  }
  if (summary.contradictions > 0) {
    notes.push([
      'alarm',
      `${who}${counted(summary.contradictions, 'contradiction')}`,
      'Intervals that start free of crossings and end with one, without a contact: contacts were lost.',
    ]);
  }
  if (summary.unknown > 0 || (summary.frames_checked === 0 && intervals.length > 0))
    notes.push([
      '',
      `${who}frames were not checked`,
      'Whether the mesh crosses itself at the start of an interval is not known.',
    ]);
  if (summary.bounded > 0) {
    notes.push([
      '',
      `${who}${counted(summary.bounded, 'contact')} with a safe bound only`,
      'Their times of impact may be early, and the pairs may stay farther apart than the least separation.',
    ]);
  }
  return notes;
}

/** Intervals of which fewer contacts are in the page than were found. */
function cappedIntervals(scene, intervals) {
  return intervals
    .filter(({ frame, vf, ee }) => {
      const [begin, end] = scene.contacts.range(frame);
      return end - begin < vf + ee;
    })
    .map(({ frame }) => frame);
}

function notesOfScene(scene, intervals) {
  const notes = [];
  const all = scene.last - scene.first + 1;
  if (scene.frames.length < all) {
    notes.push([
      '',
      'not every frame is drawn',
      `${integer(scene.frames.length)} of ${integer(all)} are in this page, with straight lines between them. ` +
        'Contacts, tables and charts are of every interval; ' +
        'contacts may lie beside the surface drawn.',
    ]);
  }
  const info = scene.contactsInfo;
  if (info && info.kept < info.found) {
    const frames = cappedIntervals(scene, intervals);
    notes.push([
      '',
      'not every contact is in this page',
      `${integer(info.kept)} of ${integer(info.found)} are: at most ${integer(info.interval_limit)} an interval ` +
        `and ${integer(info.limit)} in all, the earliest first. ` +
        `Fewer than found: ${counted(frames.length, 'interval')} (${ranges(frames)}).`,
    ]);
  }
  return notes;
}

export function create(container, report) {
  const notes = [];
  report.summaries.forEach(({ summary }, index) => {
    const who = report.summaries.length > 1 ? `${nameOf(report, index)}: ` : '';
    notes.push(...notesOfRun(summary.summary, summary.intervals, who));
  });
  if (report.scene) notes.push(...notesOfScene(report.scene, report.summaries[0]?.summary.intervals ?? []));
  for (const [grade, what, more] of notes) {
    const title = what.charAt(0).toUpperCase() + what.slice(1);
    container.append(
      element('p', { class: `note ${grade}` }, element('strong', { text: `${title}. ` }), more),
    );
  }
}
