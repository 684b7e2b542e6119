/* The deepest points of buried surfaces, wherever on them they are: one for each patch, body and part. */
#pragma once

#include "runtime/depths/deepest_cell.h"
#include "src/mesh/part_labels.h"

#include <cscd/intersections.h>

/* A triangle of which a body may contain something. */
typedef struct buried_triangle {
    uint32_t patch, body, part,
        triangle;        /* those of one patch, body and part are a group; without a patch, one each */
    double low, bound;   /* a point that is contained is as deep as low; none is deeper than the bound */
    uint32_t corners[3]; /* where their depths are in the list; UINT32_MAX: they are not contained */
    bool cut;            /* by curves, or else all of it is contained */
    uint32_t cell_count; /* of a cut one: what of it is contained, */
    size_t first_cell;   /* from here on; but not what lies near the curves: */
    double left;         /* no point of that is deeper */
    double area;         /* of that; -1: nobody has asked */
} buried_triangle;

/* Some triangles that follow each other, from the one that may be deepest on. */
typedef struct buried_group {
    size_t first, end;
} buried_group;

/* The memory of all calls; begins with the context and nothing else set. */
typedef struct deepest_finder {
    cscd_context *context;
    buried_triangle *triangles, *spare_triangles;
    size_t triangle_count, triangle_capacity, spare_capacity;
    depth_cell *cells;
    size_t cell_count, cell_capacity;
    buried_group *groups;
    size_t group_count, group_capacity;
    uint64_t *flush, *spare_flush; /* a triangle in the upper half, a body that it shares area with; sorted */
    size_t flush_count, flush_capacity;
    size_t *vertex_depths; /* per vertex and one more: where its depths begin */
    size_t vertex_capacity;
    memory_budget *budget; /* of the call; NULL: there is no limit */
} deepest_finder;

void deepest_finder_free(deepest_finder *d);

/* What is known when the deepest points are looked for. */
typedef struct depth_facts {
    const surface_cuts *found;
    const bvh *bvh;
    const outer_surface *outer;
    triangle_cuts *cuts; /* sorted */
    const part_labels *labels;
    const cscd_intersection_pair *pairs;
    size_t pair_count;
    const cscd_depth *vertices; /* sorted by (vertex, body) */
    size_t vertex_count;
    double limit;    /* see cscd_intersection_options */
    double rounding; /* what computed depths may be off by */
} depth_facts;

/* Makes room for one more item of a list. False: no memory, or no room in the budget. */
bool deepest_finder_grow(deepest_finder *d, void **items, size_t *capacity, size_t count, size_t size);

/* Lists the triangles that bodies may contain something of, by groups. False: no memory. */
bool deepest_finder_list(deepest_finder *d, const depth_facts *facts);

/* Finds the groups, and what is contained of triangles that curves cut. False: no memory. */
bool deepest_finder_begin(deepest_finder *d, const depth_facts *facts);

/* Writes the deepest point of each group that has one, in their order, and returns how many these are. out has room for all
 * groups. After a cancelled call what was written means nothing. */
size_t deepest_finder_run(deepest_finder *d, const depth_facts *facts, cscd_depth *out);
