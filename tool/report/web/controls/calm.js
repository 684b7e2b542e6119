/** Lists and legends need not change with every picture: while playing they do so a few times a second. */

const PAUSE_MS = 160;

/**
 * As `store.on`, but while playing at most once in PAUSE_MS, the last change included.
 * @param {(state: import('./store.js').State) => void} listener
 */
export function onCalmly(store, keys, listener) {
  let last = 0;
  let waiting = null;
  const call = () => {
    waiting = null;
    last = performance.now();
    listener(store.get());
  };
  return store.on([...keys, 'playing'], (state) => {
    const early = last + PAUSE_MS - performance.now();
    if (!state.playing || early <= 0) {
      clearTimeout(waiting);
      call();
    } else {
      waiting ??= setTimeout(call, early);
    }
  });
}
