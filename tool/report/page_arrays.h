/* The arrays of a page, by name: those collected, and those that follow from the mesh and the plan. */
#pragma once

#include "tool/report/packed_array.h"
#include "tool/report/report.h"

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

/* So many more may be listed. */
size_t page_arrays_room(const page_arrays *a);

void page_arrays_free(page_arrays *arrays);

/* Values of its type. */
size_t page_array_count(const page_array *array);
