/* A page: the arrays in it, by name, tables of the summary that become arrays, the template, links, and the
 * file. */
#pragma once

#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/report/collected.h"
#include "tool/report/report.h"

#include <stdbool.h>
#include <stddef.h>

/* ---- arrays by name ------------------------------------------------------------------------------------ */

enum { PAGE_ARRAYS_MAX = 240, PAGE_ARRAY_NAME_SIZE = 80 };

typedef struct page_array {
    char name[PAGE_ARRAY_NAME_SIZE];
    const char *type; /* u8, u32, f32 or f64 */
    packed_array *values;
    bool owned; /* by the list, not by the report */
} page_array;

typedef struct page_arrays {
    page_array items[PAGE_ARRAYS_MAX];
    size_t count;
} page_arrays;

/* Finishes all arrays of the page. False: out of memory; *out is to be freed all the same. */
bool page_arrays_list(report *r, page_arrays *out);
/* Lists a new, empty array, which the list owns; NULL: out of memory. */
packed_array *page_arrays_add(page_arrays *a, const char *name, const char *type);

/* The number of arrays that may still be listed. */
size_t page_arrays_room(const page_arrays *a);

void page_arrays_free(page_arrays *arrays);

/* Values of its type. */
size_t page_array_count(const page_array *array);

/* ---- tables of a summary ------------------------------------------------------------------------------- */

/* Long arrays of objects in JSON, such as the intervals of a summary, become columns in the page: a browser
 * reads these ten times as fast. */

enum { JSON_TABLE_ROWS_LEAST = 1000 };

/* Looks at the members intervals and frames of the object `text`: arrays of at least that many objects, all
 * with the same members in the same order. Moves their values into arrays of the page, whose names begin with
 * the prefix. In the text that results (to be freed) such a member is {"count": ROWS, "columns": [{"path":
 * ["ms", "total"], "array": {"name": .., "type": .., "count": ROWS}}, ..]}. In a column of type f64, NaN
 * stands for null; one with the member "texts" holds the places of its values in that array. *out becomes
 * NULL when there is no such member, or no room for the arrays. False: out of memory. */
bool json_table_move(const char *text, const char *prefix, page_arrays *arrays, char **out);

/* ---- templates ----------------------------------------------------------------------------------------- */

/* The pages without their data, template.html and jobs.html, are parts of the program. */

/* The text before the place of the data, and the text behind it. */
typedef struct report_template {
    const char *head, *tail;
    size_t head_size, tail_size;
} report_template;

typedef enum template_kind {
    TEMPLATE_REPORT, /* of one recording, or of several side by side */
    TEMPLATE_JOBS    /* a table of many */
} template_kind;

/* A template that was built in. */
bool report_template_load(template_kind kind, report_template *out, io_error *error);

/* Divides a page at its one line `<!--cscd:data-->`. */
bool report_template_divide(const char *page, size_t size, report_template *out, io_error *error);

/* ---- the file ------------------------------------------------------------------------------------------ */

/* Writes the member `arrays` of the document: what the arrays are called, their types and counts. */
void page_file_list(json *out, const page_arrays *arrays);

/* Puts the page at path in one go; document: JSON, in which any `<` is escaped here. The arrays are
 * finished. */
bool page_file_write(const char *path, const report_template *page, const char *document,
                     const page_arrays *arrays, io_error *error);

/* ---- links --------------------------------------------------------------------------------------------- */

/* Links from a page to other files are relative to its own place, so that both may move together. */

typedef struct page_folder {
    char *page, *here; /* the folder of the page, and the one that paths count from; "/" alone is "" */
} page_folder;

/* The path of a file as it is called from the page's folder, without "." and ".." but at its beginning; to be
 * freed. NULL: memory is short. */
char *page_link_make(const page_folder *folder, const char *path);
