/* Pairs that are near each other where a motion starts: what they must keep, the planes that divide the space between them, and
 * how far each vertex may go towards these. */
#pragma once

#include "runtime/detector/detector.h"

/* The rules by which pairs stay apart. */
typedef struct near_rules {
    const cscd_mesh *mesh;
    const detector_config *config;
} near_rules;

/* The distance that two features must keep: 0, the detector's separation, or that of the rules for their objects. */
double near_separation(const near_rules *r, cscd_contact_kind kind, uint32_t a, uint32_t b);

/* The number of pairs that one thread takes at a time. */
enum { NEAR_PAIRS_PER_SHARE = 1024 };

/* Returns a number that is at most the pair's distance less what it must keep, and at least 0.985 times that; see
 * pair_gap. */
double near_pair_gap(const near_rules *r, const cscd_proximity *pair, const double points[4][3]);

/* Copies the points of a pair, in the order of cscd_stencil. */
void near_pair_load(const double *x, const uint32_t vertices[4], double points[4][3]);

/* ---- planes -------------------------------------------------------------------------------------------- */

/* Ends a list of limits. */
#define DIVISION_NONE SIZE_MAX

/* A pair, and the plane between its features. A vertex, the i-th of the pair, may go by room[i] along sign * normal,
 * where the sign is that of division_sign. */
typedef struct division_plane {
    /* From b to a; 0: no plane divides the pair, and its vertices stay. That of a half-space has a length from 1 to 4, in which
     * room counts. */
    double normal[3];
    double room[4]; /* -1 if they stay */
    size_t next[4]; /* the next limit of the same vertex: 4 * pair + place */
    uint32_t vertices[4];
    cscd_contact_kind kind;
} division_plane;

/* Vertices of a, which lies above the plane, are limited downwards. */
static inline double division_sign(const division_plane *plane, int place) {
    return place < points_of_first(stencil_points(plane->kind)) ? -1.0 : 1.0;
}

typedef struct division_planes {
    division_plane *planes; /* one per near pair, in the detector's scratch memory */
    size_t count;
    size_t *first; /* per vertex: its first limit */
} division_planes;

/* Between which pairs, and for whom, planes are wanted. */
typedef struct division_quest {
    const double *x0, *x1; /* where vertices are, and where they want to be */
    double farthest;       /* that a vertex may go anyway */
    const cscd_proximities *near;
} division_quest;

/* Divides the space between all pairs. A pair that is farther apart than its separation shares what is between: an obstacle
 * takes what it needs, and else both sides get in proportion to what they need. A pair that is not comes no nearer.
 * out->planes has room for all pairs, out->first for all vertices. */
void division_planes_find(const near_rules *rules, const division_quest *quest, division_planes *out);
