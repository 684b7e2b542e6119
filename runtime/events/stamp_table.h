/* Marks on the mesh: who has been at a vertex, or at a triangle, with which pair of parts, and when. */
#pragma once

#include "src/core/context.h"

typedef struct stamp {
    uint64_t parts;   /* the key of a pair of parts */
    uint64_t frame;   /* counted from the first one */
    uint32_t element; /* a vertex, or a triangle: see mesh_rings.h */
    uint32_t owner;   /* a number of the table's user */
} stamp;

/* Stamps in the order in which they were added, found by parts and element. Begins with zeros. */
typedef struct stamp_table {
    stamp *stamps;
    uint32_t *places; /* by hash: one more than the number of a stamp; 0: nothing */
    size_t count, capacity;
    uint32_t place_mask;
} stamp_table;

/* Makes room for so many more stamps. False: no memory, and nothing has changed. */
bool stamp_table_reserve(cscd_context *context, stamp_table *t, size_t more);
void stamp_table_free(cscd_context *context, stamp_table *t);

/* NULL: there is none. Stamps move when the table grows. */
stamp *stamp_table_find(const stamp_table *t, uint64_t parts, uint32_t element);

/* Adds a stamp that is not there yet; there is room. */
void stamp_table_add(stamp_table *t, stamp added);

void stamp_table_clear(stamp_table *t);

/* Stamps were taken out, so that the others stand at the beginning of the array. */
void stamp_table_shrink(stamp_table *t, size_t count);
