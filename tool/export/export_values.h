/* What is said of each vertex and triangle of a frame, as arrays with names. */
#pragma once

#include "tool/common/part_names.h"

typedef enum export_type { EXPORT_UINT8, EXPORT_INT32, EXPORT_UINT32, EXPORT_FLOAT64 } export_type;

typedef struct export_array {
    const char *name;
    export_type type;
    void *values;
} export_array;

enum { EXPORT_ARRAYS_MAX = 16 };

typedef struct export_table {
    uint32_t count; /* of vertices or triangles */
    export_array arrays[EXPORT_ARRAYS_MAX];
    size_t array_count;
} export_table;

/* How a triangle meets others: not; only otherwise than by crossing them; it crosses one. */
typedef enum export_meeting { EXPORT_MEETS_NONE, EXPORT_TOUCHES, EXPORT_CROSSES } export_meeting;

static inline export_meeting export_meeting_of(const cscd_intersection_pair *pair) {
    return pair->kind == CSCD_INTERSECTION_CROSSING ? EXPORT_CROSSES : EXPORT_TOUCHES;
}

/* How much of a triangle an object contains. */
typedef enum export_buried { EXPORT_NOT_BURIED, EXPORT_BURIED, EXPORT_CUT } export_buried;

typedef struct export_values {
    export_table vertices, triangles;
    uint32_t *kinds[5];    /* per triangle: in so many pairs of the kind */
    uint8_t *intersecting; /* per triangle: an export_meeting */
    uint8_t *buried;       /* per triangle: an export_buried; NULL: not known */
    double *depth;         /* per vertex; NULL: not known */
    uint32_t *contacts;    /* per vertex; NULL: not counted */
} export_values;

/* What there is besides the pairs. */
typedef struct export_choice {
    bool contacts, depths;
} export_choice;

/* Allocates all arrays, and fills those that are the same in every frame. plan: NULL if there is none. On false *out
 * holds nothing to free. */
bool export_values_open(const recording *r, const part_names *parts, const cscd_plan *plan,
                        export_choice choice, export_values *out, io_error *error);
void export_values_free(export_values *values);

/* Counts the contacts of each vertex, those before among them, and begins to count anew. */
void export_values_add_contacts(export_values *values, const cscd_contacts *contacts);
void export_values_clear_contacts(export_values *values);

/* Fills the others. */
void export_values_set_frame(export_values *values, const cscd_intersection_pairs *found);

size_t export_type_size(export_type type);
