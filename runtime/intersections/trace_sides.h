/* On which side of a trace the patches lie: docs/theory/curves.md, Lemma 11. Time for one trace is that of its own links and
 * of the smaller side, since a forest that spans the nodes has each side as a few ranges of its order. */
#pragma once

#include "runtime/intersections/trace_links.h"

/* What a component has: its nodes, which links join, and its patches that no link names. */
typedef struct side_element {
    uint32_t patch; /* or UINT32_MAX: a corner between two curves that no patch is named by */
    uint32_t component;
    uint32_t begin, end; /* where what is below it in the forest lies in the order; itself is first */
    uint32_t above;
    uint32_t marked; /* one more than the last trace of whose listed side it was; 0: none */
} side_element;

/* The memory of all calls; begins with nothing but the context set. */
typedef struct trace_sides {
    cscd_context *context;
    const trace_links *links;
    side_element *elements; /* nodes, then patches without one */
    uint32_t *order;        /* the forest, component by component */
    uint32_t *list;         /* of elements: the side that was listed last */
    size_t *cursors;
    uint64_t *sums; /* of the numbers of links beside the forest, over what comes before in the order */
    size_t element_count, element_capacity;
    uint32_t *patch_elements; /* UINT32_MAX: the patch is of a closed component */
    size_t patch_capacity;
    uint32_t *link_below; /* per link: the lower one of its nodes; UINT32_MAX: it is not of the forest */
    size_t link_capacity;
    uint32_t *component_begins; /* in the order */
    size_t component_capacity;
    size_t *trace_begins;
    size_t trace_capacity;
    uint32_t *trace_passes; /* links, by trace, ascending */
    uint64_t *bounds, *spare_bounds;
    size_t pass_capacity;

    /* The last trace: side 1 is from each even bound to the next one. */
    size_t bound_count;
    uint32_t trace, component, known_side; /* the elements of known_side are those that are marked */
} trace_sides;

void trace_sides_free(trace_sides *s);

/* Links have been found. False: no memory. */
bool trace_sides_load(trace_sides *s, const surface_cuts *found, const trace_links *links);

/* Does a trace, which lies in one open component, have two sides? If so, they are those of which the next calls
 * speak. */
bool trace_sides_find(trace_sides *s, trace_number trace, uint32_t component);

/* Lists the elements of a side of the component, in no order that matters. */
size_t trace_sides_list(trace_sides *s, uint32_t side);

/* The side of a patch of the component. */
static inline uint32_t trace_side_of_patch(const trace_sides *s, uint32_t patch) {
    bool is_known = s->elements[s->patch_elements[patch]].marked == s->trace + 1;
    return is_known ? s->known_side : 1 - s->known_side;
}
