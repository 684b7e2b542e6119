/** A long table of which only the rows near the visible ones are in the document. */
import { element } from '../page/dom.js';

const ALL_BELOW = 60;
const MARGIN = 10;

const gapRow = (columns) =>
  element('tr', { class: 'gap', 'aria-hidden': 'true' }, element('td', { colspan: columns }));

/**
 * @param {HTMLElement} box what scrolls
 * @param {HTMLTableElement} table
 * @param {{columns: number, height: number, printed: number, make: () => HTMLTableRowElement,
 *          fill: (row: HTMLTableRowElement, index: number) => void}} options
 *   height: of a row, a first guess; printed: so many rows go on paper at most
 */
export function createRows(box, table, { columns, height, printed, make, fill }) {
  const body = table.tBodies[0] ?? table.createTBody();
  const above = gapRow(columns);
  const below = gapRow(columns);
  const pool = [];
  let count = 0;
  let begin = 0;
  let end = 0;
  let rowHeight = height;
  let printing = false;

  function visible() {
    if (printing) return [0, Math.min(count, printed)];
    if (count <= ALL_BELOW) return [0, count];
    const first = Math.max(0, Math.floor(box.scrollTop / rowHeight) - MARGIN);
    const shown = Math.ceil((box.clientHeight || 400) / rowHeight) + 2 * MARGIN;
    const from = Math.min(first, Math.max(0, count - shown));
    return [from, Math.min(count, from + shown)];
  }

  function place() {
    while (pool.length < end - begin) pool.push(make());
    const rows = pool.slice(0, end - begin);
    above.firstChild.style.height = `${begin * rowHeight}px`;
    below.firstChild.style.height = `${(count - end) * rowHeight}px`;
    const wanted = [begin > 0 ? above : null, ...rows, end < count && !printing ? below : null].filter(
      Boolean,
    );
    if (wanted.length !== body.childNodes.length || wanted.some((row, i) => body.childNodes[i] !== row))
      body.replaceChildren(...wanted);
    rows.forEach((row, i) => {
      row.setAttribute('aria-rowindex', String(begin + i + 2));
      fill(row, begin + i);
    });
  }

  function draw() {
    [begin, end] = visible();
    place();
    const measured = end > begin ? pool[0].offsetHeight : 0;
    if (measured > 0 && Math.abs(measured - rowHeight) > 0.5) {
      rowHeight = measured;
      [begin, end] = visible();
      place();
    }
  }

  function drawWhereMoved() {
    const [from, to] = visible();
    if (from !== begin || to !== end) draw();
  }

  box.addEventListener('scroll', drawWhereMoved, { passive: true });
  new ResizeObserver(drawWhereMoved).observe(box);
  for (const [event, on] of [
    ['beforeprint', true],
    ['afterprint', false],
  ]) {
    window.addEventListener(event, () => {
      printing = on;
      draw();
    });
  }

  return {
    /** Shows this many rows and fills them again. */
    show(rows) {
      count = rows;
      table.setAttribute('aria-rowcount', String(rows + 1));
      draw();
    },
    /** Fills the rows again that are in the document. */
    refresh: place,
    toTop() {
      box.scrollTop = 0;
    },
    /** Scrolls the box, not the page, so that the row can be seen. */
    reveal(index) {
      const head = table.tHead?.offsetHeight ?? 0;
      const top = index * rowHeight;
      if (top < box.scrollTop) box.scrollTop = top;
      else if (top + rowHeight + head > box.scrollTop + box.clientHeight)
        box.scrollTop = top + rowHeight + head - box.clientHeight;
      drawWhereMoved();
    },
  };
}
