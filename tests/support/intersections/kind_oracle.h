/* Do two triangles on small integers intersect, and how? Decided by definitions, in whole and rational numbers; and
 * random meshes with all their pairs. */
#pragma once

#include "cscd/surface.h"
#include "tests/support/random.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct integer_vector {
    int64_t x, y, z;
} integer_vector;

integer_vector integer_cross(integer_vector a, integer_vector b);
int64_t integer_dot(integer_vector a, integer_vector b);

/* Has a vertex or an edge of one triangle a point in common with the face of the other, or an edge with an edge?
 * Features that share a vertex, by the names of their vertices or, where names is NULL, by their indices, do not count.
 * Coordinates up to 1000. */
bool oracle_intersects(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                       const integer_vector *points);

/* ---- kinds of intersections ---------------------------------------------------------------------------- */

/* Decided by the intersection of both triangles as a set of points, in rational numbers, without code of the library. */

/* The kind of a pair that intersects, or is a duplicate; -1 for all others. names: of vertices, NULL: their indices. What
 * seams leave out is -1, too, unless by_index is set: then names only say which vertices are shared. Coordinates up to
 * 100. */
int oracle_kind(const uint32_t a[3], const uint32_t b[3], const uint32_t *names, bool by_index,
                const integer_vector *points);

/* How many vertices they share, if the names of a triangle's corners are different. */
uint32_t oracle_shared(const uint32_t a[3], const uint32_t b[3], const uint32_t *names);

/* ---- random meshes ------------------------------------------------------------------------------------- */

enum {
    SCENE_PARTS = 3,
    PART_VERTICES = 12,
    PART_TRIANGLES = 14,
    ALL_VERTICES = SCENE_PARTS * PART_VERTICES,
    ALL_TRIANGLES = SCENE_PARTS * PART_TRIANGLES,
    PAIRS_LEFT_OUT = 12,
    PAIRS_MAX = ALL_TRIANGLES * (ALL_TRIANGLES - 1) / 2
};

typedef struct integer_scene {
    uint32_t triangles[ALL_TRIANGLES][3]; /* in the numbering of the mesh */
    uint32_t own[ALL_TRIANGLES][3];       /* in that of their objects */
    integer_vector points[ALL_VERTICES];
    double positions[ALL_VERTICES * 3];
    bool obstacles[SCENE_PARTS];
    cscd_object_rule rules[SCENE_PARTS];
    bool has_rules;
    uint32_t seams[PAIRS_LEFT_OUT][2], names[ALL_VERTICES];
    size_t seam_count;
    uint32_t ignored[PAIRS_LEFT_OUT][2];
    size_t ignored_count;
    uint32_t active[ALL_VERTICES];
    size_t active_count; /* 0: all vertices are active */
    bool ignores;        /* a function leaves pairs out as well */
} integer_scene;

void integer_scene_make(uint64_t seed, integer_scene *out);

/* Makes a mesh and a detector in a context. */
cscd_mesh *integer_scene_mesh(const integer_scene *s, cscd_context *context);
cscd_detector *integer_scene_detector(const integer_scene *s, const cscd_mesh *mesh, cscd_method method);

/* All pairs of the kinds, in order; returns how many. */
size_t integer_scene_pairs(const integer_scene *s, uint64_t kinds, cscd_intersection out[PAIRS_MAX]);
