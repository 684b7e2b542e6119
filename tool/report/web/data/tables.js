/** The long arrays of a summary, which the page holds as columns: an object for each row that reads its values when they are asked for. */

import { BlockError, readArray } from './decode.js';

/** What a column has in row i. */
function reader({ texts }, values) {
  if (texts !== undefined) return (i) => texts[values[i]];
  return values instanceof Float64Array ? (i) => (Number.isNaN(values[i]) ? null : values[i]) : (i) => values[i];
}

/** A class whose objects are rows; columns of a longer path are members of members. */
function rowClass(columns, depth) {
  class Row {
    #i;
    constructor(i) {
      this.#i = i;
    }
    static place(row) {
      return row.#i;
    }
  }
  const names = new Set(columns.map(({ path }) => path[depth]));
  for (const name of names) {
    const own = columns.filter(({ path }) => path[depth] === name);
    const single = own.length === 1 && own[0].path.length === depth + 1;
    const Inner = single ? null : rowClass(own, depth + 1);
    const read = single ? own[0].read : (i) => new Inner(i);
    Object.defineProperty(Row.prototype, name, { enumerable: true, get() { return read(Row.place(this)); } });
  }
  return Row;
}

async function rowsOf({ count, columns }) {
  const read = await Promise.all(
    columns.map(async (column) => {
      const values = await readArray(column.array);
      if (values.length !== count) {
        throw new BlockError(column.array.name, `has ${values.length} numbers where ${count} belong`);
      }
      return { path: column.path, read: reader(column, values) };
    }),
  );
  const Row = rowClass(read, 0);
  return Array.from({ length: count }, (_, i) => new Row(i));
}

/** Puts arrays of rows in place of the columns. */
export async function readTables(summaries) {
  for (const { summary } of summaries) {
    for (const name of ['intervals', 'frames']) {
      if (summary[name]?.columns !== undefined) summary[name] = await rowsOf(summary[name]);
    }
  }
}
