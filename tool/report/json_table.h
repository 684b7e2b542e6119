/* Long arrays of objects in JSON, such as the intervals of a summary, as columns in the page: a browser reads these ten times as fast. */
#pragma once

#include "tool/report/page_arrays.h"

enum { JSON_TABLE_ROWS_LEAST = 1000 };

/* Looks at the members intervals and frames of the object `text`: arrays of at least that many objects, all with the same members in
 * the same order. Moves their values into arrays of the page, whose names begin with the prefix. In the text that results (to be freed) such a
 * member is {"count": ROWS, "columns": [{"path": ["ms", "total"], "array": {"name": .., "type": .., "count": ROWS}}, ..]}. In a column
 * of type f64, NaN stands for null; one with the member "texts" holds the places of its values in that array. *out becomes NULL when
 * there is no such member, or no room for the arrays. False: out of memory. */
bool json_table_move(const char *text, const char *prefix, page_arrays *arrays, char **out);
