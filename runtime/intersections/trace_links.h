/* Which patches of open surfaces lie on two sides of which traces of curves. */
#pragma once

#include "runtime/intersections/triangle_cuts.h"

#include <cscd/cut_offs.h>

/* The number of a trace: twice its curve, plus 1 for that on the second sheet. Of one that is both, that of the first. */
typedef uint32_t trace_number;

/* A trace passes between two nodes: over an edge between its ends, or, where it ends at a corner, between the two edges there.
 * Corners are numbered behind edges, three a triangle. */
typedef struct trace_pass {
    uint64_t link;
    trace_number trace;
    uint32_t reserved;
} trace_pass;

/* Two nodes, and the passes between them. */
typedef struct trace_link {
    uint32_t nodes[2]; /* places in the list of nodes */
    size_t first_pass, end_pass;
} trace_link;

/* Links of all open components, and the memory of all calls; begins with nothing but the context set. */
typedef struct trace_links {
    cscd_context *context;
    trace_pass *passes, *spare_passes;
    trace_link *links;
    uint64_t *nodes, *spare_nodes; /* roots of the patch finder's sets, ascending */
    size_t *node_links;            /* where the links of each node begin in link_list */
    uint32_t *link_list;
    size_t pass_count, link_count, node_count, pass_capacity;
} trace_links;

void trace_links_free(trace_links *t);

/* Does the trace have ends only where it may divide a surface: none, at its own border, or in the other trace? */
bool trace_may_divide(const cscd_mesh *mesh, const curve_joiner *j, trace_number trace);

/* Is this trace a part of the one that is both? */
static inline bool trace_is_both(const cscd_curve *c) {
    return c->swapped || (c->start == CSCD_CURVE_END_VERTEX && c->end == CSCD_CURVE_END_VERTEX);
}

/* The triangle of a trace in a piece of its curve. */
static inline uint32_t trace_triangle(const cscd_curve_piece *piece, uint32_t side) {
    return side == 0 ? piece->a : piece->b;
}

/* False: no memory. */
bool trace_links_find(trace_links *t, const surface_cuts *found);

/* A triangle at the edge or corner of a pass. */
uint32_t trace_link_triangle(const cscd_mesh *mesh, uint64_t link);

/* The place of a node in the list, or UINT32_MAX. */
uint32_t trace_links_node(const trace_links *t, uint32_t root);
