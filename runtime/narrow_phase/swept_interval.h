/* The interval that is searched: the mesh, its positions at both ends, and which pairs count. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "runtime/ccd/ccd.h"
#include "runtime/culling/culling.h"
#include "runtime/narrow_phase/pair_filter.h"
#include "src/mesh/mesh.h"

#include <math.h>
#include <string.h>

struct representatives;

/* How vertices may go from where they rest. */
typedef struct motion_bounds {
    const double *ways; /* per vertex: how far it goes at the most */
    double kept;        /* the greatest distance that a pair has to keep */
    double least;       /* pairs that are within so much of it are found anyway */
    /* Three per vertex: its motion, which it shortens. A pair that this brings no nearer to what it has to keep than `rounding`,
     * which exceeds all errors, is counted and not named. NULL: all pairs are named. */
    const double *motions;
    double rounding;
} motion_bounds;

/* All workers read it, and none writes to it. */
typedef struct swept_interval {
    const cscd_mesh *mesh;
    const double *x0, *x1;
    const bvh *bvh; /* triangle pairs are given by its slots */
    const struct representatives *representatives;
    const culling *culling; /* NULL: nothing is culled, and representatives test all pairs of features */
    const bool *culled;     /* with culling: the components whose flags say which triangle pair tests */
    bool skip_adjacent;     /* elsewhere, pairs of adjacent triangles are not reached: other pairs test their
                             * features, and orphan pairs are tested apart */
    bool closing_pass;      /* with culling: the pairs that are reached are those that were culled before */
    pair_filter filter;     /* which pairs are looked at */
    separation limit;       /* of every pair; distance 0: a contact is touching */
    bool thick;             /* a pair's distance is that of the rules, where this is the greater one */
    double tolerance;       /* of these distances, as a share of them; 0: the default */
    double activation;      /* above 0, where thick: pairs are found within so much more than that */
    const motion_bounds
        *motion;        /* pairs at rest are found only where it may bring them together; NULL: all are */
    double beyond;      /* volumes are compared within so much more than the pairs' distances */
    double floor_ratio; /* above 0: pairs that start nearer than they should have a floor instead */
    bool collecting;    /* pairs of features become the workers' candidates instead of being tested */
    bool naming;        /* pairs at rest that kernels find near become candidates, all others contacts */
} swept_interval;

/* Returns the part of an interval that the kernels read. */
static inline feature_source swept_interval_source(const swept_interval *interval) {
    return (feature_source){interval->x0, interval->x1, (const uint32_t(*)[3])interval->mesh->triangles,
                            (const uint32_t(*)[2])interval->mesh->edges};
}

static inline uint32_t vertex_component(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->triangle_components[mesh->vertex_stars[mesh->vertex_star_offsets[vertex]]];
}

static inline uint32_t edge_component(const cscd_mesh *mesh, uint32_t edge) {
    return mesh->triangle_components[mesh->edge_stars[mesh->edge_star_offsets[edge]]];
}

/* With rules, the object of a vertex, and that of an edge or a point behind the edges. */
static inline uint32_t object_of_vertex(const swept_interval *interval, uint32_t vertex) {
    const cscd_mesh *mesh = interval->mesh;
    if (vertex_has_no_triangle(mesh, vertex)) return cscd_mesh_vertex_object(mesh, vertex);
    return interval->filter.rules->component_objects[vertex_component(mesh, vertex)];
}

static inline uint32_t object_of_edge(const swept_interval *interval, uint32_t edge) {
    const cscd_mesh *mesh = interval->mesh;
    if (edge_is_loose(mesh, edge)) return cscd_mesh_vertex_object(mesh, mesh->edges[edge][0]);
    return interval->filter.rules->component_objects[edge_component(mesh, edge)];
}

/* Returns the distance within which two objects are found: that which they have to keep, or so much more; and its
 * tolerance. */
static inline separation object_separation(const swept_interval *interval, uint32_t a, uint32_t b) {
    if (!interval->thick) return interval->limit;
    double distance = pair_rules_distance(interval->filter.rules, a, b);
    if (distance < interval->limit.distance) distance = interval->limit.distance;
    if (interval->activation > 0.0) return proximity_limit(distance + interval->activation);
    return separation_limit(distance, interval->tolerance);
}

/* Returns the same of features a and b, as in cscd_contact. Points may be named as edges. */
static inline separation pair_separation(const swept_interval *interval, cscd_contact_kind kind, uint32_t a,
                                         uint32_t b) {
    if (!interval->thick) return interval->limit;
    const uint32_t *objects = interval->filter.rules->component_objects;
    if (kind == CSCD_CONTACT_VF)
        return object_separation(interval, object_of_vertex(interval, a),
                                 objects[interval->mesh->triangle_components[b]]);
    if (kind == CSCD_CONTACT_EE)
        return object_separation(interval, object_of_edge(interval, a), object_of_edge(interval, b));
    uint32_t first = kind == CSCD_CONTACT_EV ? object_of_edge(interval, a) : object_of_vertex(interval, a);
    return object_separation(interval, first, kind == CSCD_CONTACT_VH ? b : object_of_vertex(interval, b));
}

static inline double larger_way(double a, double b) {
    return a > b ? a : b;
}

/* The ways of the vertices of a triangle, and of an edge. */
static inline double way_of_triangle(const swept_interval *interval, uint32_t triangle) {
    const uint32_t *v = interval->mesh->triangles[triangle];
    const double *ways = interval->motion->ways;
    return larger_way(larger_way(ways[v[0]], ways[v[1]]), ways[v[2]]);
}

static inline double way_of_edge(const swept_interval *interval, uint32_t edge) {
    const uint32_t *v = interval->mesh->edges[edge];
    return larger_way(interval->motion->ways[v[0]], interval->motion->ways[v[1]]);
}

/* The distance within which two sides may come together that go so far, or that is looked at anyway. The share more covers the
 * rounding of the sum. */
static inline double distance_on_ways(const motion_bounds *motion, double ways) {
    return (motion->kept + larger_way(ways, motion->least)) * (1.0 + 0x1p-17);
}

/* Lowers the limit of a pair, VF or EE, to the ways of its sides. */
static inline separation separation_on_ways(const swept_interval *interval, cscd_contact_kind kind,
                                            uint32_t a, uint32_t b, separation limit) {
    if (interval->motion == NULL) return limit;
    const double way = kind == CSCD_CONTACT_VF ? interval->motion->ways[a] + way_of_triangle(interval, b)
                                               : way_of_edge(interval, a) + way_of_edge(interval, b);
    const double distance = distance_on_ways(interval->motion, way);
    return distance < limit.distance ? proximity_limit(distance) : limit;
}

/* The distance within which volumes of a pair are compared. */
static inline double pair_reach(const swept_interval *interval, cscd_contact_kind kind, uint32_t a,
                                uint32_t b) {
    return pair_separation(interval, kind, a, b).distance + interval->beyond;
}

/* ---- positions ---------------------------------------------------------------------------------------- */

static inline void load_point(const swept_interval *interval, uint32_t vertex, elementary_query *query,
                              int i) {
    memcpy(query->x0[i], interval->x0 + (size_t)vertex * 3, sizeof query->x0[i]);
    memcpy(query->x1[i], interval->x1 + (size_t)vertex * 3, sizeof query->x1[i]);
}

/* The points of vertex a and triangle b, or of the edges a and b. */
static inline void swept_interval_load(const swept_interval *interval, cscd_contact_kind kind, uint32_t a,
                                       uint32_t b, elementary_query *query) {
    const cscd_mesh *mesh = interval->mesh;
    if (kind == CSCD_CONTACT_VF) {
        load_point(interval, a, query, 0);
        for (int i = 0; i < 3; i++) load_point(interval, mesh->triangles[b][i], query, 1 + i);
    } else {
        for (int i = 0; i < 4; i++) load_point(interval, mesh->edges[i < 2 ? a : b][i % 2], query, i);
    }
}

/* An axis-aligned box of moving features, in double. */
typedef struct swept_box {
    double low[3], high[3];
} swept_box;

static inline void swept_box_add(const swept_interval *interval, uint32_t vertex, swept_box *box) {
    for (int k = 0; k < 3; k++) {
        double start = interval->x0[(size_t)vertex * 3 + (size_t)k];
        double end = interval->x1[(size_t)vertex * 3 + (size_t)k];
        double low = start < end ? start : end, high = start < end ? end : start;
        box->low[k] = low < box->low[k] ? low : box->low[k];
        box->high[k] = high > box->high[k] ? high : box->high[k];
    }
}

static inline swept_box swept_box_of(const swept_interval *interval, const uint32_t *vertices, int count) {
    swept_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < count; i++) swept_box_add(interval, vertices[i], &box);
    return box;
}

/* Rounding is monotone, so a gap of no more than the distance is never found to be more: nothing needs to be
 * rounded outward here. */
static inline bool swept_boxes_within(const swept_box *a, const swept_box *b, double distance) {
    for (int k = 0; k < 3; k++) {
        if (b->low[k] - a->high[k] > distance || a->low[k] - b->high[k] > distance) return false;
    }
    return true;
}
