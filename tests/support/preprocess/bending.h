/* A body that bends: what plans for a motion are made for. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/models/body_of.h"

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
