/* The parts of a triangle that curves cut, with how often bodies wind around them. */
#pragma once

#include "src/core/context.h"
#include "src/core/memory_budget.h"

/* A straight cut, or piece of a curve, in the plane of the triangle. Bodies are numbered by slots. */
typedef struct cut_line {
    double from[2], to[2];
    uint32_t slot;
    uint32_t number;  /* the caller's, who finds the line by it when lines have been sorted */
    int rise;         /* the body's number to the left of the line less that to the right */
    double low, high; /* set by cut_triangle_measure: the lesser and the greater of from[0] and to[0] */
} cut_line;

/* A curve passes through the border of the triangle. */
typedef struct cut_border {
    uint32_t edge; /* 0 to 2; edge i leads from corner i to the next one */
    double s;      /* how far along */
    uint32_t slot;
    int jump; /* what the body's number increases by, going along the edge */
} cut_border;

/* A part of the triangle on which all numbers are the same, between two lines along y: at x[i] it reaches from low[i] to
 * high[i]. */
typedef struct cut_part {
    double x[2], low[2], high[2];
    const int32_t *numbers; /* per slot */
    const uint32_t *listed; /* the slots whose numbers are not 0, in any order */
    uint32_t listed_count;
} cut_part;

static inline double cut_part_area(const cut_part *p) {
    return 0.5 * (p->x[1] - p->x[0]) * ((p->high[0] - p->low[0]) + (p->high[1] - p->low[1]));
}

/* Corners turn counter-clockwise. Slot 0 is the triangle's own body, whose number holds on the side of the normal. */
typedef struct cut_triangle {
    double corners[3][2];
    cut_line *lines;
    cut_border *borders; /* sorted by edge and s */
    int32_t
        *corner_numbers; /* per corner and slot: at the corner, on the side of the edge that begins there */
    size_t line_count, border_count;
    uint32_t slot_count;
} cut_triangle;

/* Numbers of slots, most of which are 0. */
typedef struct slot_numbers {
    int32_t *numbers;
    uint32_t *listed; /* the slots whose numbers are not 0 */
    uint32_t *places; /* per slot that is listed: where */
    uint32_t count;
} slot_numbers;

/* Memory for triangles with so many lines and slots. */
typedef struct cut_memory {
    size_t line_capacity, slot_capacity;
    cut_line *spare_lines;
    uint32_t *active;              /* lines, in the order of a cross-section */
    double *breaks, *spare_breaks; /* where lines begin and end */
    double *crossings;             /* of two lines */
    size_t crossing_capacity;
    size_t crossings_taken; /* of the budget, */
    memory_budget *budget;  /* which is the call's; NULL: there is no limit */
    slot_numbers below;     /* at the border below a slab */
    slot_numbers here;      /* in a part */
} cut_memory;

/* A call begins, with room for so many lines and slots in each of its triangles. False: that does not fit the budget. */
bool cut_memory_begin(cut_memory *m, memory_budget *budget, size_t lines, size_t slots);

/* Makes room; false: no memory. */
bool cut_memory_reserve(cscd_context *context, cut_memory *m, size_t lines, size_t slots);
void cut_memory_free(cscd_context *context, cut_memory *m);

/* Calls take for each part, up to rounding. Lines may be put in another order. False: no memory. */
bool cut_triangle_divide(cscd_context *context, cut_triangle *t, cut_memory *m,
                         void (*take)(void *data, const cut_part *part), void *data);
