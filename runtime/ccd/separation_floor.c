/* Floors: how near two features may come that are nearer already than they should be.
 * docs/solver/guarantees.md says what they are for; docs/theory/floors.md has the lemmas that this file
 * relies on. */

#include "runtime/ccd/feature_moment.h"

#include "src/core/vec3.h"

#include <stdint.h>
#include <string.h>

/* ---- the floor at a moment --------------------------------------------------------------------------- */

/* A distance that is below the computed one by no more than this cannot be improved much. */
static const double tight = 0x1p-44;

/* The edges in which the shortest connection ends. */
static unsigned edges_inside(const feature_moment *m) {
    unsigned edges = 0;
    for (int i = 0; i < separating_plane_edges(m->features.kind); i++)
        edges |= (unsigned)m->shortest.inside[i] << i;
    return edges;
}

/* Returns a distance that the features certainly have, the greatest that is found or one that is enough. The
 * planes are those by which approach_within proves that they stay apart. */
static double least_distance(const feature_moment *m, double enough) {
    double greatest = 0.0, wanted = min_of(enough, m->distance - tight);
    unsigned inside = edges_inside(m), sets = 1u << separating_plane_edges(m->features.kind);
    for (unsigned i = 0; i < sets && greatest < wanted; i++) {
        separating_plane plane = separating_plane_along(&m->features, &m->shortest, inside ^ i);
        greatest = max_of(greatest, separating_plane_gap(&m->features, &plane));
    }
    return greatest;
}

enum { POWERS_MAX = 64 };

/* Rung k is the product of the powers ratio^(2^i) over the bits of k, from the highest on. So it has one
 * value, bit for bit, wherever it comes from: pairs that are pressed come as near to it as doubles allow. */
static double rung_of(const floor_ladder *ladder, uint64_t k) {
    double powers[POWERS_MAX], rung = ladder->distance;
    powers[0] = ladder->ratio;
    for (int i = 1; i < POWERS_MAX; i++) powers[i] = powers[i - 1] * powers[i - 1];
    for (int i = POWERS_MAX; i-- > 0;) {
        if ((k >> i & 1) != 0) rung *= powers[i];
    }
    return rung;
}

/* Rungs are so far from each other that their products have the order of their numbers. */
double separation_floor_rung(const floor_ladder *ladder, double distance) {
    double powers[POWERS_MAX], power = ladder->ratio, rung = ladder->distance;
    uint64_t k = 0;
    int count = 0;
    if (!(distance > 0.0) || rung < distance) return distance > 0.0 ? rung : 0.0;
    for (; count < POWERS_MAX && rung * power >= distance; power *= power) powers[count++] = power;
    while (count-- > 0) {
        if (rung * powers[count] < distance) continue;
        rung *= powers[count];
        k |= (uint64_t)1 << count;
    }
    return rung_of(ladder, k + 1);
}

/* The excess over the floor that the distance must have at the start, in local units: the tolerance and the
 * rounding. */
static double margin_above(const local_query *local, const floor_ladder *ladder, double floor) {
    return ladder->tolerance * floor + FLOOR_FINEST * local_query_extent_at_start(local);
}

/* Returns what the distance surely exceeds at the start, in local units, or more than `enough` if that is
 * so. */
static double sure_distance(const local_query *local, const floor_ladder *ladder, double enough) {
    feature_moment m = feature_moment_start(local);
    double finest = FLOOR_FINEST * local_query_extent_at_start(local), share = 1.0 + ladder->tolerance;
    return (least_distance(&m, (enough * share + finest) * (1.0 + 0x1p-40)) - finest) / share;
}

static local_query query_at_rest(const double x[4][3], cscd_contact_kind kind) {
    elementary_query query;
    memcpy(query.x0, x, sizeof query.x0);
    memcpy(query.x1, x, sizeof query.x1);
    return local_query_of(&query, kind, FRAME_MOVING);
}

double separation_floor_at(const double x[4][3], cscd_contact_kind kind, const floor_ladder *ladder) {
    local_query local = query_at_rest(x, kind);
    double finest = FLOOR_FINEST * local_query_extent_at_start(&local),
           sure = sure_distance(&local, ladder, ladder->distance * local.scale);
    if (!(sure > finest)) return 0.0;
    double floor = separation_floor_rung(ladder, sure / local.scale);
    return floor * local.scale < finest ? 0.0 : floor;
}

/* ---- a motion ---------------------------------------------------------------------------------------- */

/* A motion is followed down to this share of its margin above the floor, so that it is stopped little later
 * than its end would be refused. */
static const double share_left = 0.125;

/* Does the motion certainly stay above the floor? The distance that it is proven to keep is below that at
 * the start by more than the tolerance, so no motion is refused at its start. */
static bool stays_above(const elementary_query *query, cscd_contact_kind kind, const floor_ladder *ladder,
                        double floor, elementary_contact *contact, bool *bounded) {
    local_query local = local_query_of(query, kind, FRAME_MOVING);
    double lowest = floor * local.scale, margin = margin_above(&local, ladder, lowest);
    double tolerance = max_of(share_left * margin, SEPARATION_FINEST_LOCAL);
    local.distance = lowest + max_of(margin - tolerance - 0.5 * SEPARATION_FINEST_LOCAL, 0.0);
    return !approach_within(query, &local, tolerance, contact, bounded);
}

/* Are the features at rest surely above the floor, so that it is no lower at the next start? Should their
 * extent have become so great that it is 0 there, they may have come nowhere near it. */
static bool is_above(const double x[4][3], cscd_contact_kind kind, const floor_ladder *ladder, double floor) {
    local_query local = query_at_rest(x, kind);
    return sure_distance(&local, ladder, floor * local.scale) > floor * local.scale;
}

/* Describes the features at the end of the motion, where they have fallen below their floor. The time is an
 * estimate of when they have: the motion itself stays above. */
static void describe_end(const elementary_query *query, cscd_contact_kind kind, const floor_ladder *ladder,
                         double floor, elementary_contact *contact) {
    elementary_query end;
    local_query local0 = query_at_rest((const double(*)[3])query->x0, kind);
    local_query local1 = query_at_rest((const double(*)[3])query->x1, kind);
    double before = sure_distance(&local0, ladder, INFINITY) / local0.scale - floor;
    double after = sure_distance(&local1, ladder, INFINITY) / local1.scale - floor;
    memcpy(end.x0, query->x1, sizeof end.x0);
    memcpy(end.x1, query->x1, sizeof end.x1);
    separation_describe(&end, kind, contact);
    contact->toi = min_of(max_of(before / (before - after), 0.0), 1.0);
}

floor_verdict separation_floor_test(const elementary_query *query, cscd_contact_kind kind,
                                    const floor_ladder *ladder, elementary_contact *contact, bool *bounded) {
    double floor = separation_floor_at((const double(*)[3])query->x0, kind, ladder);
    if (floor == 0.0) return FLOOR_NONE;
    if (memcmp(query->x0, query->x1, sizeof query->x0) == 0) return FLOOR_KEPT;
    *bounded = false;
    if (!stays_above(query, kind, ladder, floor, contact, bounded)) return FLOOR_BROKEN;
    if (is_above((const double(*)[3])query->x1, kind, ladder, floor)) return FLOOR_KEPT;
    describe_end(query, kind, ladder, floor, contact);
    return FLOOR_BROKEN;
}
