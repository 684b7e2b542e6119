/* Wires, points and half-spaces: which pairs with triangles, vertices and each other are tested. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* ---- elements ------------------------------------------------------------------------------------------ */

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
    return 0.5 * (distance + interval->activation + interval->beyond) * (1.0 + 0x1p-40);
}

/* ---- pairs --------------------------------------------------------------------------------------------- */

/* A face and the ends of an element that this tests, and the triangle's own edges and a wire. The objects are looked at
 * with each other. */
void loose_pairs_with_triangle(const swept_interval *interval, const loose_element *element,
                               uint32_t triangle, contact_worker *worker);

/* Two elements: nothing, unless their objects are looked at with each other and they share no vertex. */
void loose_pairs_of_elements(const swept_interval *interval, const loose_element *a, const loose_element *b,
                             contact_worker *worker);

/* Are two elements, by their numbers as edges, ever in contact? Where a point and a wire, or two points, have no distance
 * to keep they are not looked at: as they move they never meet exactly, or only where rounding decides. */
static inline bool loose_edges_meet(const swept_interval *interval, uint32_t a, uint32_t b) {
    uint32_t larger = a > b ? a : b;
    return !edge_is_point(interval->mesh, larger) ||
           pair_separation(interval, CSCD_CONTACT_EE, a, b).distance > 0.0;
}

/* ---- searches ------------------------------------------------------------------------------------------ */

/* A search of the interval, whose trees have been refitted to it, and whose elements have been moved. */
typedef struct loose_search {
    const swept_interval *interval;
    const loose_elements *elements;
    uint32_t worker_count; /* that share the search */
} loose_search;

/* Puts the worker's share of all pairs that may come within their distance in the worker's queue, and decides
 * them. The worker of a pair depends on the number of workers alone. */
void loose_search_test(const loose_search *search, uint32_t worker_index, contact_worker *worker);

/* The same for every pair, without a box: the reference. */
void loose_search_test_all(const loose_search *search, uint32_t worker_index, contact_worker *worker);

/* Tests one pair, named as in a cscd_contact; of triangles, too. */
void loose_search_test_pair(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                            contact_worker *worker);

/* One vertex and a half-space. */
void half_spaces_test_vertex(const swept_interval *interval, uint32_t vertex, uint32_t object,
                             contact_worker *worker);

/* The worker's share of vertices against half-spaces. Candidates are never collected of these: a test costs no more. */
void half_spaces_test(const swept_interval *interval, uint32_t worker_index, uint32_t worker_count,
                      contact_worker *worker);
