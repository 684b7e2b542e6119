/* The interval that is searched: the mesh, its positions at both ends, and which pairs count. */
#pragma once

#include "runtime/bvh/traversal.h"
#include "runtime/ccd/ccd_kernels.h"
#include "runtime/ccd/elementary.h"
#include "runtime/ccd/min_separation.h"
#include "runtime/culling/culling.h"
#include "src/mesh/mesh.h"

struct representatives;

/* All lanes read it, and none writes to it. */
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
    separation limit;       /* distance 0: a contact is touching */
    bool collecting;        /* pairs of features become the lanes' candidates instead of being tested */
} swept_interval;

/* What the kernels read of an interval. */
static inline feature_source swept_interval_source(const swept_interval *interval) {
    return (feature_source){interval->x0, interval->x1, (const uint32_t(*)[3])interval->mesh->triangles,
                            (const uint32_t(*)[2])interval->mesh->edges};
}

/* The points of vertex a and triangle b, or of the edges a and b. */
void swept_interval_load(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                         elementary_query *query);
