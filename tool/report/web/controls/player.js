/** Moves the time by playing, stepping and jumping, always through the store. */

import { finder, intervalCount, lastAtOrBefore, timeWithin } from '../page/intervals.js';

const SPEEDS = [1, 2, 5, 10, 15, 24, 30, 60];

/** A contact at the very end of an interval is shown in this interval, not in the next one. */
const WITHIN = 1 - 1e-9;

/** How many contacts each interval has by the summary, and which intervals have any. */
function contactCounts(report) {
  const find = finder(report.summaries[0]?.summary);
  return Uint32Array.from({ length: intervalCount(report.scene) }, (_, i) => {
    const row = find(report.scene.numbers[i]);
    return row === undefined ? 0 : row.vf + row.ee;
  });
}

export function createPlayer(report, store) {
  const { first, last, numbers, fps } = report.scene;
  const speeds = SPEEDS.includes(fps ?? 30) ? SPEEDS : [...SPEEDS, fps].sort((a, b) => a - b);
  const counts = contactCounts(report);
  const withContacts = [];
  counts.forEach((count, i) => {
    if (count > 0) withContacts.push(numbers[i]);
  });
  const greatest = counts.reduce((at, count, i) => (count > counts[at] ? i : at), 0);
  const most = withContacts.length > 0 ? numbers[greatest] : null;

  let request = null;
  let then = 0;

  function advance(now) {
    request = null;
    const state = store.get();
    if (!state.playing) return;
    const elapsed = Math.min(now - then, 250); // a page in the background does not leap
    then = now;
    let time = state.time + Math.max(0, elapsed / 1000) * state.speed;
    if (time >= last) {
      if (!state.loop) {
        store.set({ time: last, playing: false });
        return;
      }
      time = first + ((time - first) % (last - first));
    }
    store.set({ time, selected: null });
    request = requestAnimationFrame(advance);
  }

  store.on(['playing'], ({ playing }) => {
    if (playing && request === null) {
      then = performance.now();
      request = requestAnimationFrame(advance);
    }
  });

  /** The frame at or before a time. */
  const frameAt = (time) => numbers[Math.max(0, lastAtOrBefore(numbers, time))];
  const clamp = (time) => Math.min(last, Math.max(first, time));
  const show = (time) => store.set({ time: clamp(time), playing: false, selected: null });
  const player = {
    first,
    last,
    numbers,
    speeds,
    counts,
    withContacts,
    most,
    play() {
      if (last === first) return;
      store.set(store.get().time >= last ? { time: first, playing: true, selected: null } : { playing: true });
    },
    pause() {
      store.set({ playing: false, time: store.get().time });
    },
    toggle() {
      if (store.get().playing) player.pause();
      else player.play();
    },
    stepTo: show,
    toFirst: () => show(first),
    toLast: () => show(last),
    previous: () => show(numbers.findLast((number) => number < store.get().time) ?? first),
    next: () => show(numbers[lastAtOrBefore(numbers, store.get().time) + 1] ?? last),
    /** null where there is none. */
    frameWithContactsBefore: (time) => withContacts.findLast((frame) => frame < frameAt(time)) ?? null,
    frameWithContactsAfter: (time) => withContacts.find((frame) => frame > frameAt(time)) ?? null,
    previousWithContacts() {
      const frame = player.frameWithContactsBefore(store.get().time);
      if (frame !== null) show(frame);
    },
    nextWithContacts() {
      const frame = player.frameWithContactsAfter(store.get().time);
      if (frame !== null) show(frame);
    },
    toMost() {
      if (most !== null) show(most);
    },
    /** Goes to an event: the view follows the state. */
    toEvent(event) {
      const { worst } = report.scene.answers.events[event];
      store.set({ event: null });
      store.set({ event, time: worst, playing: false, selected: null });
    },
    stepEvent(by) {
      const count = report.scene.answers?.events.length ?? 0;
      const { event } = store.get();
      if (count > 0) player.toEvent(event === null ? (by > 0 ? 0 : count - 1) : (event + by + count) % count);
    },
    /** Goes to the moment of a contact and selects it; null selects none. */
    select(contact) {
      if (contact === null) {
        store.set({ selected: null });
        return;
      }
      const { interval, toi } = report.scene.contacts;
      const time = timeWithin(interval[contact], Math.min(toi[contact], WITHIN), report.scene);
      store.set({ selected: contact, time, playing: false });
    },
    faster: () => changeSpeed(1),
    slower: () => changeSpeed(-1),
  };

  function changeSpeed(direction) {
    const { speed } = store.get();
    const next = direction > 0 ? speeds.find((value) => value > speed) : speeds.findLast((value) => value < speed);
    if (next !== undefined) store.set({ speed: next });
  }

  return player;
}
