/* The bodies of models/shapes for tests, the invariants of their regions, and bodies that bend: what plans for a
 * motion are made for. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/catalogue.h"
#include "src/mesh/mesh.h"

/* Makes a body with exactly that many triangles, or its default number when that is 0; the caller frees
 * it. The test fails when it cannot be made. */
body body_of(body_kind kind, uint32_t triangle_count);

/* ---- their meshes and regions -------------------------------------------------------------------------- */

/* Checks that regions are numbered from 0 by first triangles and are connected, and that none is in two
 * components. */
void check_regions(const cscd_mesh *mesh, const uint32_t *regions, uint32_t region_count);

/* Makes the mesh of a body, in a context of its own with that many threads. */
cscd_mesh *body_mesh(const body *b, uint32_t thread_count);
void body_mesh_destroy(cscd_mesh *mesh);

/* ---- bodies that bend ---------------------------------------------------------------------------------- */

enum { BENDING_FRAMES = 12 };

/* A body, and frames that bend it. */
typedef struct bending {
    body shape;
    cscd_context *context;
    cscd_mesh *mesh;
    double *frames[BENDING_FRAMES];
    cscd_view views[BENDING_FRAMES];
    const cscd_view *items[BENDING_FRAMES];
} bending;

/* A body whose longest axis bends to an arc of this angle, from frame to frame. A capsule is three times as long as it is else. */
bending bending_of(body_kind kind, uint32_t triangles, double angle, int threads);
void bending_free(bending *b);

/* Bends the longest axis of a body to an arc of this angle. */
void bending_bend(const body *b, double angle, double *out);

/* Views hold addresses of the frames, so they are made where the structure stays. */
const cscd_view *const *bending_frames(bending *b);

cscd_plan *bending_plan(const bending *b, cscd_method method, const cscd_view *const *frames, uint32_t count);

/* Compares regions and points bit for bit. */
void bending_expect_same(const cscd_plan *a, const cscd_plan *b, uint32_t triangles);
