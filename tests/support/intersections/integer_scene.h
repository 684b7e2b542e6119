/* Random meshes on small integers, in which triangles cross, touch, fold, repeat and have no area, and random things that
 * leave pairs out; with all pairs by the oracle. */
#pragma once

#include "tests/support/intersections/kind_oracle.h"
#include "tests/support/random.h"

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
