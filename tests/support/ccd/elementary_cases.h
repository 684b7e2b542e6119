/* The elementary tests as a step runs them, queries built backwards from a contact, and checks of what was found. */
#pragma once

#include "benchmarks/lib/pair_batches.h"

#include <stdbool.h>

/* Through the feature queue, on every instruction set of the processor. Where these, or the sizes of batches, make a difference, all
 * of the following say so and abort. */

/* A batch of one. *hit is written when they touch only. */
elementary_verdict pair_test(cscd_contact_kind kind, const elementary_query *query, elementary_contact *hit);

/* All queries, in random order and in batches of random sizes. */
void pair_test_all(cscd_contact_kind kind, const elementary_query *queries, size_t count,
                   query_answer *answers);

/* How many queries of the last call each level decided. */
const uint64_t *pair_test_decided(void);

/* For pairs that have a mesh: the contacts, sorted by a and b, in memory that lasts until the next call. */
const cscd_contact *pair_test_source(const feature_source *source, cscd_contact_kind kind,
                                     const uint32_t (*pairs)[2], size_t count, size_t *contact_count);

/* ---- queries with a known answer ----------------------------------------------------------------------- */

/* A query with a contact known to be in it, or known to be missed. */
typedef struct contact_case {
    cscd_contact_kind kind;
    elementary_query query;
    double size; /* of the features and of their paths, to a factor of 10 */
    double toi, u, v;
} contact_case;

/* Features of any size and place that pass through each other at toi in (0.02, 0.98), both parameters inside,
 * in general position: they are not slivers, and meet at a speed and an angle that fix toi to 1e-10. */
contact_case random_contact(cscd_contact_kind kind);

/* The four points are coplanar once in the interval and change sides there: by the signs of the Bernstein
 * coefficients, all of them far from zero. */
bool crosses_once(const elementary_query *query, cscd_contact_kind kind);

/* Where they are coplanar at the start: they never are again, by the same signs. */
bool leaves_at_start(const elementary_query *query, cscd_contact_kind kind);

/* The only time at which the points are coplanar is toi; then the point of contact lies a millionth of the
 * feature's length outside a border. No contact. */
contact_case random_side_miss(cscd_contact_kind kind);

/* The features approach, the interval ends a millionth before the only time of contact. No contact. */
contact_case random_short_miss(cscd_contact_kind kind);

/* The points in another order; end before start; coordinates times 2^exponent. */
elementary_query query_permuted(const elementary_query *query, const int order[4]);
elementary_query query_reversed(const elementary_query *query);
elementary_query query_scaled(const elementary_query *query, int exponent);

/* From positions at toi = before / (before + after) and velocities: exact where the numbers are small
 * integers. */
elementary_query query_through(const double at[4][3], const double velocity[4][3], double before,
                               double after);

/* Asserts what holds for every contact: the points named by u and v are within 1e-8 of the largest
 * displacement and 64 units in the last place of each other, the interval and the features contain them,
 * point is their midpoint; the normal is unit, perpendicular to the features, and against the motion, or 0
 * where the features have none. */
void check_hit(cscd_contact_kind kind, const elementary_query *query, double size,
               const elementary_contact *hit);

/* These print the query where they fail. A contact at toi or before it: */
elementary_contact check_touches(cscd_contact_kind kind, const elementary_query *query, double toi);

/* The first contact, at toi: what is found is not later, and at most `early` earlier. */
elementary_contact check_first(cscd_contact_kind kind, const elementary_query *query, double toi,
                               double early);

/* No contact. */
void check_apart(cscd_contact_kind kind, const elementary_query *query);
