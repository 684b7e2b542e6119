/* Proximity at one moment: the pairs are compared with brute force, their distances with long double. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "runtime/solver/solver.h"
#include "tests/support/calls.h"
#include "tests/support/ccd/feature_distance.h"
#include "tests/support/oracle.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene interval, still; /* large; one test at a time; still: at x0 throughout */

/* The scenes are a few units large, and their edges some tenths. */
static const double distances[] = {1e-9, 1e-3, 0.03, 0.25};
enum { DISTANCE_COUNT = sizeof distances / sizeof *distances };

static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_BRUTE,
                                      CSCD_METHOD_ICCD};
enum { METHOD_COUNT = sizeof methods / sizeof *methods };

static rig rig_of(const scene *s, cscd_method method, uint32_t threads) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method_or_none(method);
    return rig_create(s, threads, &options);
}

static void hold_still(void) {
    still = interval;
    memcpy(still.x1, still.x0, sizeof still.x1);
}

/* ---- against brute force ------------------------------------------------------------------------------- */

static int compare_names(const void *left, const void *right) {
    const oracle_contact *l = left, *r = right;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static elementary_query query_of(const rig *r, const cscd_proximity *p, const double *x) {
    cscd_stencil s = stencil_of_item(r->mesh, p);
    elementary_query query;
    for (int i = 0; i < 4; i++) {
        memcpy(query.x0[i], x + (size_t)s.vertices[i] * 3, sizeof query.x0[i]);
        memcpy(query.x1[i], query.x0[i], sizeof query.x1[i]);
    }
    return query;
}

static long double extent_of(const elementary_query *query) {
    long double largest = 0.0L;
    for (int i = 0; i < 12; i++) {
        long double offset = (long double)query->x0[i / 3][i % 3] - query->x0[0][i % 3];
        largest = fmaxl(largest, fabsl(offset));
    }
    return largest;
}

/* Moves the features to the origin without rounding: differences of nearby coordinates are exact. */
static void bring_home(elementary_query *query) {
    double origin[3];
    memcpy(origin, query->x0[0], sizeof origin);
    for (int i = 0; i < 12; i++) {
        query->x0[i / 3][i % 3] -= origin[i % 3];
        query->x1[i / 3][i % 3] = query->x0[i / 3][i % 3];
    }
}

/* Compares the stencil with the sum that it stands for. */
static void check_stencil(const rig *r, const cscd_proximity *p, const double *x, long double rounding) {
    cscd_stencil s = stencil_of_item(r->mesh, p);
    const double *first = x + (size_t)s.vertices[0] * 3;
    long double sum = 0.0L, apart[3] = {0};
    for (int i = 0; i < 4; i++) {
        sum += s.weights[i];
        for (size_t k = 0; k < 3; k++)
            apart[k] +=
                (long double)s.weights[i] * (x[(size_t)s.vertices[i] * 3 + k] - (long double)first[k]);
    }
    assert_true(fabsl(sum) <= 0x1p-51L);
    long double square = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
    assert_true(fabsl(sqrtl(square) - p->distance) <= rounding);
    for (int k = 0; k < 3 && p->distance > 1e4L * rounding; k++)
        assert_true(fabsl(apart[k] - p->distance * p->normal[k]) <= 8.0L * rounding);
}

/* Checks that the normal is a unit vector, or 0 where the features touch, and that the point is the middle
 * of the named points. */
static void check_frame(const rig *r, const cscd_proximity *p, const double *x, long double rounding) {
    cscd_stencil s = stencil_of_item(r->mesh, p);
    double length =
        sqrt(p->normal[0] * p->normal[0] + p->normal[1] * p->normal[1] + p->normal[2] * p->normal[2]);
    assert_true(fabs(length - 1.0) <= 0x1p-50 || (length == 0.0 && p->distance <= 1e4L * rounding));
    double point[3];
    cscd_proximity_point(p, x, point);
    for (size_t k = 0; k < 3; k++) {
        long double sum = 0.0L, largest = 0.0L;
        for (int i = 0; i < 4; i++) {
            long double coordinate = x[(size_t)s.vertices[i] * 3 + k];
            sum += 0.5L * fabsl(s.weights[i]) * coordinate;
            largest = fmaxl(largest, fabsl(coordinate));
        }
        assert_true(fabsl(sum - point[k]) <= rounding + 0x1p-50L * largest);
    }
}

/* Returns by how much the features are nearer than the named points, relative to the extent. */
static long double check_proximity(const rig *r, const cscd_proximity *p, const double *x, double distance) {
    elementary_query query = query_of(r, p, x);
    bring_home(&query);
    cscd_contact_kind kind = p->kind == CSCD_CONTACT_VF ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
    long double extent = extent_of(&query), rounding = 0x1p-48L * extent;
    double u, v;
    cscd_stencil_parameters(p->kind, p->weights, &u, &v);
    assert_true(u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0);
    if (kind == CSCD_CONTACT_VF) assert_true(u + v <= 1.0 + 0x1p-52);
    long double features = feature_distance(kind, &query, 0.0L);
    long double named = named_distance(kind, &query, 0.0L, u, v);
    assert_true(fabsl(named - p->distance) <= rounding);
    assert_true(features <= p->distance + rounding && named <= features + rounding);
    assert_true(p->distance <= distance * (1.0 + 1e-6) + 0x1p-42L * extent);
    check_stencil(r, p, x, rounding);
    check_frame(r, p, x, rounding);
    return extent > 0.0L ? (named - features) / extent : 0.0L;
}

static cscd_proximities find_near(const rig *r, const double *x, double distance) {
    cscd_proximities found = {.count = 4711};
    expect_ok(find_near_packed(r->detector, x, distance, &found));
    return found;
}

static void compare_with_oracle(const rig *r, const oracle_list *truth, double distance, long double *worst) {
    cscd_proximities found = find_near(r, still.x0, distance);
    assert_int_equal(found.count, truth->count);
    for (size_t i = 0; i < found.count; i++) {
        const cscd_proximity *p = &found.items[i];
        const oracle_contact *t = &truth->items[i];
        assert_true(p->kind == t->kind && p->a == t->a && p->b == t->b && t->toi == 0.0);
        *worst = fmaxl(*worst, check_proximity(r, p, still.x0, distance));
    }
}

TEST(every_method_equals_brute_force) {
    oracle_list truth = {0};
    size_t pairs = 0, empty = 0;
    long double worst = 0.0L;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < 3; seed++) {
            double distance = distances[((uint64_t)family + seed) % DISTANCE_COUNT];
            separation limit = proximity_limit(distance);
            scene_make((scene_family)family, seed, &interval);
            hold_still();
            oracle_find_within(&still, &limit, &truth);
            if (truth.count > 0) qsort(truth.items, truth.count, sizeof *truth.items, compare_names);
            for (int m = 0; m < METHOD_COUNT; m++) {
                rig r = rig_of(&still, methods[m], 1 + (uint32_t)((seed + (uint64_t)m) % 3));
                compare_with_oracle(&r, &truth, distance, &worst);
                if (seed == 1 && m == 0) compare_with_oracle(&r, &truth, distance, &worst);
                rig_destroy(&r);
            }
            pairs += truth.count;
            empty += truth.count == 0;
        }
    }
    print_message("  %zu pairs, %zu moments without; named points are nearest to 2^%.0Lf\n", pairs, empty,
                  worst > 0.0L ? ceill(log2l(worst)) : -99.0L);
    assert_true(pairs > 2000 && empty > 5);
    oracle_free(&truth);
}

/* The largest distances find all pairs without a common vertex. */
TEST(any_length_will_do) {
    static const double lengths[] = {0x1p-300, 1e3, 0x1p300};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        if (family != SCENE_SPIKE && family != SCENE_GRID) continue;
        scene_make((scene_family)family, 3, &interval);
        rig brute = rig_of(&interval, CSCD_METHOD_BRUTE, 1), trees = rig_of(&interval, CSCD_METHOD_NONE, 2);
        for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
            cscd_proximities truth = find_near(&brute, interval.x0, lengths[i]);
            cscd_proximities found = find_near(&trees, interval.x0, lengths[i]);
            assert_int_equal(found.count, truth.count);
            if (found.count > 0)
                assert_memory_equal(found.items, truth.items, found.count * sizeof *found.items);
            assert_true(family == SCENE_GRID || (found.count > 5000) == (lengths[i] > 100.0));
        }
        rig_destroy(&trees);
        rig_destroy(&brute);
    }
}

static void scale_scene(double *x, uint32_t vertex_count, int exponent) {
    for (uint32_t i = 0; i < vertex_count * 3; i++) x[i] = ldexp(x[i], exponent);
}

TEST(same_when_scaled) {
    static const int exponents[] = {-250, -140, 100, 270};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (size_t e = (size_t)family % 2; e < sizeof exponents / sizeof *exponents; e += 2) {
            scene_make((scene_family)family, 11, &interval);
            rig plain = rig_of(&interval, CSCD_METHOD_NONE, 1),
                scaled = rig_of(&interval, CSCD_METHOD_NONE, 1);
            cscd_proximities expected = find_near(&plain, interval.x0, 0.03);
            hold_still();
            scale_scene(still.x0, still.vertex_count, exponents[e]);
            cscd_proximities found = find_near(&scaled, still.x0, ldexp(0.03, exponents[e]));
            assert_int_equal(found.count, expected.count);
            for (size_t i = 0; i < found.count; i++) {
                const cscd_proximity *p = &found.items[i], *t = &expected.items[i];
                assert_true(p->kind == t->kind && p->a == t->a && p->b == t->b &&
                            p->distance == ldexp(t->distance, exponents[e]));
                assert_memory_equal(p->weights, t->weights, sizeof p->weights);
                assert_memory_equal(p->normal, t->normal, sizeof p->normal);
            }
            rig_destroy(&scaled);
            rig_destroy(&plain);
        }
    }
}

/* A small shape lies so far from the origin that coordinates round to 1e-7. */
TEST(same_as_brute_force_far_away) {
    oracle_list truth = {0};
    size_t pairs = 0;
    long double worst = 0.0L;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 17, &interval);
        for (uint32_t i = 0; i < interval.vertex_count * 3; i++) interval.x0[i] += i % 3 == 1 ? -3e8 : 1e9;
        hold_still();
        separation limit = proximity_limit(0.1);
        oracle_find_within(&still, &limit, &truth);
        if (truth.count > 0) qsort(truth.items, truth.count, sizeof *truth.items, compare_names);
        for (int m = 0; m < METHOD_COUNT; m++) {
            rig r = rig_of(&still, methods[m], 1);
            compare_with_oracle(&r, &truth, 0.1, &worst);
            rig_destroy(&r);
        }
        pairs += truth.count;
    }
    assert_true(pairs > 200);
    oracle_free(&truth);
}

/* ---- queries between steps ----------------------------------------------------------------------------- */

static void expect_same_state(const rig *r, const rig *other) {
    cscd_counters own = cscd_detector_counters(r->detector),
                  expected = cscd_detector_counters(other->detector);
    assert_memory_equal(&own, &expected, sizeof own);
    for (uint32_t c = 0; c < cscd_mesh_component_count(r->mesh); c++) {
        cscd_guarantee g = cscd_detector_guarantee(r->detector, c),
                       h = cscd_detector_guarantee(other->detector, c);
        assert_true(g.complete == h.complete && g.start_embedded == h.start_embedded && g.reason == h.reason);
    }
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(r->mesh); t++)
        assert_int_equal(cscd_detector_orientation(r->detector, t),
                         cscd_detector_orientation(other->detector, t));
}

/* Asks between the steps of one detector but not of the other, and compares their contacts. */
TEST(steps_do_not_notice) {
    static const cscd_method of_steps[] = {CSCD_METHOD_SINGLE, CSCD_METHOD_NONE, CSCD_METHOD_ICCD,
                                           CSCD_METHOD_BRUTE};
    static double x2[SCENE_VERTICES_MAX * 3];
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (int m = 0; m < 4; m++) {
            if (m != 0 && (family + m) % 3 != 0) continue;
            scene_make((scene_family)family, 5 + (uint64_t)m, &interval);
            for (uint32_t i = 0; i < interval.vertex_count * 3; i++)
                x2[i] = 2.0 * interval.x1[i] - interval.x0[i];
            const double *frames[] = {interval.x0, interval.x1, x2, interval.x0};
            rig plain = rig_of(&interval, of_steps[m], 1), asked = rig_of(&interval, of_steps[m], 1);
            for (int f = 0; f < 3; f++) {
                cscd_contacts expected, found;
                expect_ok(step_packed(plain.detector, frames[f], frames[f + 1], &expected));
                expect_ok(step_packed(asked.detector, frames[f], frames[f + 1], &found));
                assert_int_equal(found.count, expected.count);
                if (found.count > 0)
                    assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
                expect_same_state(&asked, &plain);
                cscd_timings before = cscd_detector_timings(asked.detector);
                find_near(&asked, frames[f + 1], 0.05);
                find_near(&asked, frames[0], 0.2);
                cscd_timings after = cscd_detector_timings(asked.detector);
                assert_memory_equal(&after, &before, sizeof after);
                expect_same_state(&asked, &plain);
            }
            rig_destroy(&asked);
            rig_destroy(&plain);
        }
    }
}

/* ---- arguments ----------------------------------------------------------------------------------------- */

static void expect_refused(const rig *r, const double *x, double distance, cscd_proximities *out,
                           const char *words) {
    expect_invalid(r->context, find_near_packed(r->detector, x, distance, out), words);
}

TEST(bad_arguments_are_named) {
    static const double bad[] = {0.0, -1.0, NAN, INFINITY, 5e-324, 0x1p-301, 0x1p301};
    cscd_proximities out = {.count = 4711};
    scene_make(SCENE_SPIKE, 1, &interval);
    rig r = rig_create(&interval, 1, NULL);
    assert_int_equal(find_near_packed(NULL, interval.x0, 0.1, &out), CSCD_NULL_OBJECT);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect_refused(&r, interval.x0, bad[i], &out, "distance is ");
    expect_refused(&r, NULL, 0.1, &out, "positions is NULL");
    expect_refused(&r, interval.x0, 0.1, NULL, "out is NULL");
    interval.x0[5] = INFINITY;
    expect_refused(&r, interval.x0, 0.1, &out, "positions: vertex 1 has z");
    assert_true(out.items == NULL && out.count == 4711);
    rig_destroy(&r);
}
