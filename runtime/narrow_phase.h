/* From triangle pairs to contacts: representatives, feature volumes, elementary tests. */
#ifndef CSCD_NARROW_PHASE_H
#define CSCD_NARROW_PHASE_H

#include "runtime/culling.h"
#include "runtime/elementary.h"
#include "runtime/kdop.h"
#include "runtime/separation.h"
#include "runtime/traversal.h"
#include "src/mesh.h"

/* The interval at hand; read by all lanes. */
typedef struct swept_interval {
    const cscd_mesh *mesh;
    const double *x0, *x1;
    const kdop *vertex_volumes;     /* swept, widened by limit; NULL: pairs are filtered by the caller */
    const uint8_t *representatives; /* NULL when features are paired by the caller */
    const culling *culling;         /* NULL: nothing is culled, every pair of triangles is reached */
    bool closing;                   /* with culling: the pairs reached are those that it culled before */
    bool skip_adjacent;             /* triangles that share a vertex are not tested: as published */
    separation limit;               /* distance 0: a contact is touching */
} swept_interval;

/* What one thread finds. */
typedef struct contact_lane {
    _Alignas(CACHE_LINE_SIZE) cscd_contact *contacts;
    size_t count, capacity;
    uint64_t feature_pairs;
    uint64_t decided[ELEMENTARY_LEVEL_COUNT]; /* elementary tests, by what decided them */
    uint64_t separations;                     /* tests for minimum separation */
    bool out_of_memory;
} contact_lane;

void contact_lane_reset(contact_lane *lane);

/* Tests all pairs of features that the two triangles represent and that share no vertex. */
void narrow_phase_test(const swept_interval *interval, triangle_pair pair, contact_lane *lane);

/* Tests one pair of features without a common vertex, and adds a contact where they touch, or come within the
 * limit's distance. */
void narrow_phase_test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                          contact_lane *lane);
void narrow_phase_test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_lane *lane);

#endif
