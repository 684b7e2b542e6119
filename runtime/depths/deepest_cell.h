/* The deepest point of a triangle, or of what is buried of it: docs/theory/curves.md, Lemma 9. */
#pragma once

#include "runtime/depths/near_surface.h"

#include <cscd/intersections.h>

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

/* What the deepest points of several cells are looked for with. */
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
    size_t cells_left; /* so many more may be divided */
} depth_search;

/* A cell, or a part of one, that is looked at further. */
typedef struct cell_part {
    deep_point corners[3];
    double above;    /* no point of it is deeper */
    uint32_t number; /* of the cell */
    int level;
} cell_part;

/* The parts of all cells that wait: the one that promises most is looked at first, since the deeper the best point is, the fewer
 * others are wanted. Where it is full, a part is looked at to its end. Begins with no parts. */
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

/* Looks at all that waits. */
void depth_search_finish(depth_search *s, depth_queue *queue);
