/* Which pairs wait after changes of what is left out: lists of everything that touches, gone through one by one. */
#pragma once

#include "tests/support/oracle.h"

enum { LEFT_OUT_SEAMS_MAX = 64, LEFT_OUT_IGNORED_MAX = 256 };

/* What a caller leaves out at one time, in the words of the API. */
typedef struct left_out {
    uint32_t seams[LEFT_OUT_SEAMS_MAX][2], ignored[LEFT_OUT_IGNORED_MAX][2];
    size_t seam_count, ignored_count;
    oracle_rules rules; /* distances below 0: objects that are not looked at */
} left_out;

/* The same, and the name of each vertex: the smallest that is sewn to it. */
typedef struct named_left_out {
    left_out what;
    uint32_t names[SCENE_VERTICES_MAX];
} named_left_out;

typedef struct waiting_oracle {
    const cscd_mesh *mesh; /* for the ends of edges */
    const scene *scene;
    named_left_out now;
    named_left_out *former; /* since positions were last seen */
    size_t former_count;
    oracle_list pairs; /* of features and of triangles that wait */
    oracle_list touching;
} waiting_oracle;

waiting_oracle waiting_oracle_start(const cscd_mesh *mesh, const scene *s, const left_out *now);
void waiting_oracle_free(waiting_oracle *o);

/* The caller changes what is left out. */
void waiting_oracle_change(waiting_oracle *o, const left_out *next);

/* Positions are seen; where a motion starts, pairs are let go. */
void waiting_oracle_see(waiting_oracle *o, const double *x, bool motion_starts);

/* Is the pair left out now, because of what the caller says, or because it waits? Intersections are those at x. */
bool waiting_oracle_covers(const waiting_oracle *o, cscd_contact_kind kind, uint32_t a, uint32_t b,
                           const double *x);

/* Drops what is left out from a list of features. */
void waiting_oracle_filter(const waiting_oracle *o, oracle_list *list);

/* Lists all pairs of triangles that intersect, with a time of 0, and without what is left out. */
void waiting_oracle_intersections(const waiting_oracle *o, const double *x, oracle_list *out);

/* How many pairs of features wait, and how many of triangles. */
size_t waiting_oracle_features(const waiting_oracle *o);
size_t waiting_oracle_triangles(const waiting_oracle *o);
