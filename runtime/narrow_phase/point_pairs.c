/* Pairs of features that have no mesh: four points each, decided by the queue and the kernels of a step. */
#include "runtime/narrow_phase/point_pairs.h"

#include "runtime/ccd/connection.h"
#include "runtime/narrow_phase/narrow_phase.h"
#include "src/mesh/stencil.h"

#include <assert.h>

/* The features of POINT_PAIRS_MAX pairs: triangle i and the edges 2 i and 2 i + 1 belong to pair i, as do the points
 * from 4 i on. */
typedef struct pair_features {
    uint32_t triangles[POINT_PAIRS_MAX][3], edges[2 * POINT_PAIRS_MAX][2];
} pair_features;

static void name_features(uint32_t count, pair_features *out) {
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < 3; k++) out->triangles[i][k] = 4 * i + 1 + k;
        for (uint32_t k = 0; k < 4; k++) out->edges[2 * i + k / 2][k % 2] = 4 * i + k;
    }
}

static void queue_pairs(const swept_interval *interval, cscd_contact_kind kind, uint32_t count,
                        contact_lane *lane) {
    for (uint32_t i = 0; i < count; i++) {
        if (kind == CSCD_CONTACT_VF)
            narrow_phase_test_vf(interval, 4 * i, i, lane);
        else
            narrow_phase_test_ee(interval, 2 * i, 2 * i + 1, lane);
    }
    narrow_phase_finish(interval, lane);
}

/* The lane has room for a contact of each pair, so it never asks the allocator for more. */
_Static_assert((int)POINT_PAIRS_MAX <= (int)LANE_FIRST_BLOCK,
               "the contacts of all pairs are one block of a lane");
void point_pairs_test(cscd_context *context, const point_pairs *pairs, separation limit,
                      point_pair_found *found, void *user) {
    pair_features features;
    cscd_contact contacts[POINT_PAIRS_MAX];
    contact_lane lane;
    uint32_t count = (uint32_t)pairs->count;
    assert(pairs->count <= POINT_PAIRS_MAX);
    name_features(count, &features);
    lane.blocks[0] = contacts;
    lane.block_count = 1;
    contact_lane_reset(&lane);
    cscd_mesh mesh = {.context = context, .triangles = features.triangles, .edges = features.edges};
    swept_interval interval = {.mesh = &mesh, .x0 = pairs->x0, .x1 = pairs->x1, .limit = limit};
    queue_pairs(&interval, pairs->kind, count, &lane);
    for (size_t i = 0; i < lane.count; i++)
        found(user, contacts[i].a / (pairs->kind == CSCD_CONTACT_VF ? 4 : 2), &contacts[i]);
}

double point_pair_distance(cscd_contact_kind kind, const double (*x)[3], double u, double v) {
    const double *points[4] = {x[0], x[1], x[2], x[3]};
    double weights[4], apart[3];
    stencil_weights(kind, u, v, weights);
    connection_between(points, weights, points_of_first(kind), apart);
    return connection_length(apart);
}
