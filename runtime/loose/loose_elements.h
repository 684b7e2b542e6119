/* Wires and points, ordered in space anew for each interval, and the boxes around them. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* A wire or a point. */
typedef struct loose_element {
    uint32_t edge, object; /* a point is one of the edges behind the mesh's */
    uint32_t ends; /* bit i: it tests end i of its edge against faces, which one of the wires there does */
} loose_element;

/* Eight elements, or eight nodes of the level below, are a node. Boxes hold what moves in them during the interval, less
 * the mean motion of all elements, and are widened so that two of them overlap where pairs come within their distance. */
enum { LOOSE_LEVEL_MAX = 12, LOOSE_NODE_CHILDREN = 8 };
_Static_assert(3 * (LOOSE_LEVEL_MAX - 1) >= 32, "one node holds as many elements as there are numbers for");

typedef struct loose_level {
    uint32_t count;
    swept_box *boxes;
    object_set *sets; /* with rules: the objects below */
    bool *active;     /* with an active set: is a feature below active? */
} loose_level;

/* A number along a curve that keeps neighbours together, and an element. */
typedef struct loose_key {
    uint64_t code;
    uint64_t element;
} loose_key;

typedef struct loose_elements {
    cscd_context *context;
    uint32_t count;
    loose_element *items;   /* in the order of the mesh */
    loose_key *order;       /* per place in the tree: its element */
    loose_key *spare_order; /* for sorting */
    double common[3];       /* what boxes are less by, over the whole interval */
    int level_count;
    loose_level levels[LOOSE_LEVEL_MAX]; /* level 0 has the elements themselves, in their places */
} loose_elements;

/* On failure *out holds nothing. */
cscd_status loose_elements_create(const cscd_mesh *mesh, loose_elements *out);
void loose_elements_destroy(loose_elements *e);

/* Orders the elements by where they are at the start, and encloses them. Allocates nothing. */
void loose_elements_move(loose_elements *e, const swept_interval *interval);

/* Half of the distance within which the boxes of an object are compared. The halves of two objects together are no less
 * than what their pairs have to keep. */
static inline double loose_reach(const swept_interval *interval, uint32_t object) {
    double own = interval->thick ? interval->filter.rules->reaches[object] : 0.0;
    double distance = own > interval->limit.distance ? own : interval->limit.distance;
    return 0.5 * (distance + interval->beyond) * (1.0 + 0x1p-40);
}
