/** Which events of two runs are the same: what is fixed, what is new, and what is still there. */
import { worseThan } from '../page/events.js';
import { lastAtOrBefore } from '../page/intervals.js';

const NEAREST = 64; // so many candidates of an event are looked at, the nearest ones

const overlap = (a, b) => Math.min(a.last, b.last) - Math.max(a.first, b.first) + 1;

/** Of the places in the two worst frames; infinite where one is not known. */
function distance({ point: p }, { point: q }) {
  return p && q ? Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) : Infinity;
}

function byParts(events) {
  const groups = new Map();
  for (const event of events) {
    const key = JSON.stringify([event.a, event.b].sort());
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(event);
  }
  return groups;
}

/** The nearest first; of equally near ones those that have the most frames in common. */
function nearer(s, t) {
  if (s.apart !== t.apart) return s.apart < t.apart ? -1 : 1;
  return t.common - s.common;
}

function candidatesOf(before, after) {
  return before.flatMap((a) => {
    const found = [];
    for (const b of after) {
      const common = overlap(a, b);
      if (common > 0) found.push({ a, b, common, apart: distance(a, b) });
    }
    return found.sort(nearer).slice(0, NEAREST);
  });
}

/** Pairs of events of the same parts. In any one frame an event has at most one partner, so that two places stay two,
 * but an event that pauses in the other run has a partner before the pause and one after it. */
function partnersOf(before, after) {
  const partners = new Map([...before, ...after].map((event) => [event, []]));
  const free = (event, other) => partners.get(event).every((partner) => overlap(partner, other) <= 0);
  for (const { a, b } of candidatesOf(before, after).sort(nearer)) {
    if (!free(a, b) || !free(b, a)) continue;
    partners.get(a).push(b);
    partners.get(b).push(a);
  }
  return partners;
}

/** All events that partners join with this one. */
function joined(event, partners, seen) {
  const group = [event];
  seen.add(event);
  for (let i = 0; i < group.length; i++) {
    for (const partner of partners.get(group[i])) {
      if (seen.has(partner)) continue;
      seen.add(partner);
      group.push(partner);
    }
  }
  return group;
}

export const worstOf = (events) => events.reduce((most, event) => (worseThan(event, most) ? event : most));

/** The frames, ascending, that one run has looked at and the other has not. Intersections are seen in frames that were
 * checked, contacts in all that were replayed. */
function unseenFrames(finder, other, checked) {
  const framesOf = (run) => run.frames.filter(({ crossing }) => !checked || crossing !== null).map(({ frame }) => frame);
  const seen = new Set(framesOf(other));
  return framesOf(finder).filter((frame) => !seen.has(frame));
}

/** Returns whether the other run has looked at all frames of an event that the run which found it looked at: else it cannot
 * say that the event is not there. */
function witnessOf(finder, other) {
  const unseen = [false, true].map((checked) => unseenFrames(finder, other, checked));
  return (event) => {
    const frames = unseen[Number(event.pairs > 0 || event.depth > 0)];
    return !(frames[lastAtOrBefore(frames, event.last)] >= event.first);
  };
}

const RANK = { new: 0, still: 1, fixed: 2, unknown: 3 };

/**
 * @param {object} before a summary with events
 * @param {object} after another one
 * @returns {{state: 'new'|'still'|'fixed'|'unknown', before: object[], after: object[]}[]} each event of either run once;
 *   the worst of each state first. unknown: only one run has it, and the other did not look at all of its frames
 */
export function matchEvents(before, after) {
  const first = byParts(before.events);
  const second = byParts(after.events);
  const lookedAtAfter = witnessOf(before, after);
  const lookedAtBefore = witnessOf(after, before);
  const rows = [];
  for (const key of new Set([...first.keys(), ...second.keys()])) {
    const mine = first.get(key) ?? [];
    const own = new Set(mine);
    const partners = partnersOf(mine, second.get(key) ?? []);
    const seen = new Set();
    for (const event of partners.keys()) {
      if (seen.has(event)) continue;
      const group = joined(event, partners, seen);
      const row = { before: group.filter((one) => own.has(one)), after: group.filter((one) => !own.has(one)) };
      if (row.before.length > 0 && row.after.length > 0) rows.push({ ...row, state: 'still' });
      else if (row.before.length > 0) rows.push({ ...row, state: lookedAtAfter(event) ? 'fixed' : 'unknown' });
      else rows.push({ ...row, state: lookedAtBefore(event) ? 'new' : 'unknown' });
    }
  }
  const worst = ({ before: a, after: b }) => worstOf(b.length > 0 ? b : a);
  const order = (r, s) => (worseThan(worst(r), worst(s)) ? -1 : worseThan(worst(s), worst(r)) ? 1 : 0);
  return rows.sort((r, s) => RANK[r.state] - RANK[s.state] || order(r, s));
}
