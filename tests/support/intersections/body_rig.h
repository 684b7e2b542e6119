/* Some bodies, one object each, and what is found where they intersect. */
#pragma once

#include "runtime/intersections/depths.h"
#include "runtime/intersections/overlaps.h"
#include "tests/support/scenes.h"

enum { BODIES_MAX = 4 };

/* What a body's positions and triangles are; numbers are the body's own. */
typedef struct body_part {
    uint32_t first_vertex, vertex_count, first_triangle, triangle_count;
    uint32_t triangles[SCENE_TRIANGLES_MAX * 3];
} body_part;

typedef struct body_rig {
    scene all;
    body_part bodies[BODIES_MAX];
    uint32_t body_count;
    cscd_context *context;
    cscd_mesh *mesh;
    bvh trees;
    curve_joiner joiner;
    patch_finder finder;
    overlap_finder overlap_finder;
    depth_finder depth_finder;
    cscd_intersection *pairs;
    cscd_curves curves;
    cscd_patches patches;
    cscd_overlaps overlaps;
    cscd_depths depths;
} body_rig;

/* What was added to rig->all since the last call, or the beginning, is a body. */
void body_rig_end_body(body_rig *r);

/* Adds an axis-aligned box to what will be a body. */
void body_rig_add_box(body_rig *r, const double low[3], const double size[3]);

/* Begins without a body; then finds everything, and frees it. */
void body_rig_begin(body_rig *r);
void body_rig_find(body_rig *r);
void body_rig_free(body_rig *r);

/* The overlap of two objects, 0 if they have none. */
cscd_overlap body_rig_overlap(const body_rig *r, uint32_t a, uint32_t b);
