/* The deepest points of buried surfaces, wherever on them they are: of a triangle or what is buried of it, and of each patch, body
 * and part. docs/theory/curves.md, Lemma 9. */
#pragma once

#include "runtime/depths/depths.h"
#include "runtime/depths/outer_surface.h"
#include "src/mesh/parts.h"

/* ---- cells --------------------------------------------------------------------------------------------- */

#define DEPTH_RESOLUTION 0x1p16

/* A triangle in space, all of which counts. */
typedef struct depth_cell {
    double corners[3][3];
    uint32_t near; /* a triangle of the surface that may be near; UINT32_MAX: nobody knows */
} depth_cell;

/* A point, and the nearest one of the outer surface; or a near one, and then the depth is no more than this. */
typedef struct deep_point {
    double x[3], depth;
    outer_point nearest;
} deep_point;

/* A search for the deepest points of several cells. */
typedef struct depth_search {
    const outer_surface *outer;
    const surface_cuts *found;
    const bvh *bvh;
    uint32_t body;
    double limit; /* until it is known whether the depth is above this; INFINITY: 1 % is enough */
    double
        rounding; /* what computed depths may be off by; without a limit, DEPTH_RESOLUTION as much is enough, too */
    deep_point best; /* begins with depth -1 */
    uint32_t best_cell;
    double bound;      /* no point of the cells so far is deeper; begins with 0 */
    size_t cells_left; /* the number of cells that may still be divided */
} depth_search;

/* A cell, or a part of one, that is looked at further. */
typedef struct cell_part {
    deep_point corners[3];
    double above;    /* no point of it is deeper */
    uint32_t number; /* of the cell */
    int level;
} cell_part;

/* The parts of all cells that are still open. The most promising one comes first, since fewer others are
 * needed the deeper the best point is. If the queue is full, a part is examined to its end. Begins with no
 * parts. */
enum { DEPTH_QUEUE_MAX = 12 };

typedef struct depth_queue {
    cell_part parts[DEPTH_QUEUE_MAX];
    uint32_t count;
} depth_queue;

/* May a point that is no deeper than the bound matter, or is the best one good enough? */
bool depth_search_wants(const depth_search *s, double bound);

/* Looks at the corners of a cell, and puts it into the queue if it may have deeper points. number: what best_cell becomes if there is one.
 * above: no point of it is deeper. known: the depths of its corners, none of which is deeper than the best; NULL: nobody knows any,
 * or not this one. */
void depth_search_cell(depth_search *s, depth_queue *queue, const depth_cell *cell, uint32_t number,
                       double above, const cscd_depth *const known[3]);

/* Examines all open parts. */
void depth_search_finish(depth_search *s, depth_queue *queue);

/* ---- groups of triangles ------------------------------------------------------------------------------- */

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

/* The facts that a search for the deepest points begins with. */
typedef struct depth_facts {
    const surface_cuts *found;
    const bvh *bvh;
    const outer_surface *outer;
    triangle_cuts *cuts; /* sorted */
    const part_labels *labels;
    const cscd_intersection *pairs;
    size_t pair_count;
    const cscd_depth *vertices; /* sorted by (vertex, body) */
    size_t vertex_count;
    double limit;    /* see cscd_intersection_options */
    double rounding; /* what computed depths may be off by */
} depth_facts;

/* Finds the groups, and what is contained of triangles that curves cut. False: no memory. */
bool deepest_finder_begin(deepest_finder *d, const depth_facts *facts);

/* Writes the deepest point of each group that has one, in their order, and returns how many these are. out has room for all
 * groups. After a cancelled call what was written means nothing. */
size_t deepest_finder_run(deepest_finder *d, const depth_facts *facts, cscd_depth *out);

/* ---- all depths ---------------------------------------------------------------------------------------- */

/* A vertex that a body contains, or the part of an edge from s[0] to s[1]. */
typedef struct depth_question {
    uint32_t vertex, edge, face, patch, body;
    double s[2];
} depth_question;

struct depth_finder {
    cscd_context *context;
    outer_surface outer;
    deepest_finder deepest;
    depth_question *questions;
    size_t question_count, question_capacity;
    cscd_depth *depths;
    size_t depth_capacity;
    cscd_patch_depth *patches;
    size_t patch_capacity;
};
