/* Minimum separation through the detector: every method equals brute force, any thread count gives the same
 * bits, and a larger distance only adds pairs. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { INTERVALS_PER_FAMILY = 8 };

static scene interval; /* The scenes are a few units large, and their edges some tenths. */

/* The scenes are a few units large, their edges some tenths. */
static const double distances[] = {1e-8, 1e-3, 0.03, 0.2};
enum { DISTANCE_COUNT = sizeof distances / sizeof *distances };

static cscd_detector_options options_within(double distance, cscd_method method) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = distance;
    options.method = method;
    return options;
}

/* ---- against brute force ---------------------------------------------------------------------------- */

static void compare_with_truth(const oracle_list *truth, const cscd_detector_options *options) {
    rig r = rig_create(&interval, 1, options);
    cscd_contacts found = rig_step(&r, &interval);
    cscd_counters counters = cscd_detector_counters(r.detector);
    uint64_t bounded = 0;
    oracle_expect(truth, &found);
    for (size_t i = 0; i < found.count; i++) bounded += found.items[i].bounded;
    assert_int_equal(counters.vf + counters.ee, found.count);
    assert_int_equal(counters.bounded, bounded);
    assert_true(counters.tests >= found.count);
    assert_int_equal(counters.by_signs + counters.by_roots + counters.by_exact, 0);
    rig_destroy(&r);
}

TEST(every_method_equals_brute_force) {
    oracle_list truth = {0};
    size_t contacts = 0, with_contact = 0, intervals = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < INTERVALS_PER_FAMILY; seed++) {
            double distance = distances[(family + (int)seed) % DISTANCE_COUNT];
            bool roomy = seed % 2 == 1; /* pairs within the tolerance are reported by all methods or none */
            separation limit = {distance, (roomy ? 0.5 : 1e-6) * distance};
            scene_make((scene_family)family, seed, &interval);
            for (uint32_t i = 0; seed % 4 == 3 && i < interval.vertex_count; i++)
                interval.x1[i * 3 + 2] += 37.5;
            oracle_find_within(&interval, &limit, &truth);
            for (int method = 0; method < 2; method++) {
                cscd_detector_options options = options_within(distance, (cscd_method)method);
                if (!roomy) compare_with_truth(&truth, &options);
                options.tolerance = roomy ? 0.5 : 1e-6; /* the value that 0 stands for, unless it is roomy */
                if (roomy || method == CSCD_METHOD_NONE) compare_with_truth(&truth, &options);
            }
            contacts += truth.count;
            with_contact += truth.count > 0;
            intervals++;
        }
    }
    print_message("  %zu contacts in %zu of %zu intervals\n", contacts, with_contact, intervals);
    assert_true(with_contact > intervals / 2 && with_contact < intervals);
    oracle_free(&truth);
}

/* The counters of a step are its own, not the sums of all steps. */
TEST(tests_are_counted_for_each_step) {
    scene_make(SCENE_TWO_SPHERES, 1, &interval);
    cscd_detector_options options = options_within(0.2, CSCD_METHOD_NONE);
    rig r = rig_create(&interval, 1, &options);
    rig_step(&r, &interval);
    uint64_t tests = cscd_detector_counters(r.detector).tests;
    rig_step(&r, &interval);
    assert_true(tests > 0);
    assert_int_equal(cscd_detector_counters(r.detector).tests, tests);
    rig_destroy(&r);
}

/* Far smaller and larger scenes round their volumes differently, but have the same pairs. */
TEST(same_pairs_when_scaled) {
    static const int exponents[] = {-250, -140, 100, 270};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 11, &interval);
        cscd_detector_options options = options_within(0.03, CSCD_METHOD_NONE);
        rig r = rig_create(&interval, 1, &options);
        cscd_contacts expected = rig_step(&r, &interval);
        for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
            scene_make((scene_family)family, 11, &interval);
            for (uint32_t i = 0; i < interval.vertex_count * 3; i++) {
                interval.x0[i] = ldexp(interval.x0[i], exponents[e]);
                interval.x1[i] = ldexp(interval.x1[i], exponents[e]);
            }
            options.min_separation = ldexp(0.03, exponents[e]);
            rig scaled = rig_create(&interval, 1, &options);
            cscd_contacts found = rig_step(&scaled, &interval);
            assert_int_equal(found.count, expected.count);
            for (size_t i = 0; i < found.count; i++) {
                const cscd_contact *c = &found.items[i], *t = &expected.items[i];
                assert_true(c->kind == t->kind && c->a == t->a && c->b == t->b && c->toi == t->toi);
            }
            rig_destroy(&scaled);
        }
        rig_destroy(&r);
    }
}

/* ---- more distance, more pairs ---------------------------------------------------------------------- */

static int compare_pairs(const void *left, const void *right) {
    const cscd_contact *l = left, *r = right;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

/* Returns the contacts sorted by their pairs; the caller frees them. */
static cscd_contact *pairs_within(double distance, size_t *count) {
    cscd_detector_options options = options_within(distance, CSCD_METHOD_NONE);
    rig r = rig_create(&interval, 1, &options);
    cscd_contacts found = rig_step(&r, &interval);
    cscd_contact *pairs = malloc((found.count + 1) * sizeof *pairs);
    assert_non_null(pairs);
    if (found.count > 0) memcpy(pairs, found.items, found.count * sizeof *pairs);
    qsort(pairs, found.count, sizeof *pairs, compare_pairs);
    *count = found.count;
    rig_destroy(&r);
    return pairs;
}

TEST(a_larger_distance_only_adds_pairs) {
    size_t touching = 0, added = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 30; seed < 34; seed++) {
            scene_make((scene_family)family, seed, &interval);
            size_t fewer_count, count;
            cscd_contact *fewer = pairs_within(0.0, &fewer_count);
            touching += fewer_count;
            for (int i = 0; i < DISTANCE_COUNT; i++) {
                cscd_contact *pairs = pairs_within(distances[i], &count);
                for (size_t j = 0; j < fewer_count; j++) {
                    const cscd_contact *same = bsearch(&fewer[j], pairs, count, sizeof *pairs, compare_pairs);
                    assert_non_null(same);
                    assert_true(same->toi <= fewer[j].toi + 1e-9);
                }
                added += count - fewer_count;
                free(fewer);
                fewer = pairs;
                fewer_count = count;
            }
            free(fewer);
        }
    }
    assert_true(touching > 0 && added > touching);
}

/* ---- arguments -------------------------------------------------------------------------------------- */

static void expect_refused(const rig *r, double min_separation, double tolerance, const char *word) {
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = min_separation;
    options.tolerance = tolerance;
    expect_invalid(r->context, detector_create_here(r->mesh, NULL, &options, &detector), word);
    assert_null(detector);
}

TEST(unfit_lengths_are_refused) {
    static const double bad[] = {NAN, INFINITY, -INFINITY, -1.0, -1e-300, 5e-324, 0x1p-301, 0x1p301};
    static const double no_shares[] = {NAN, INFINITY, -INFINITY, -1.0, -1e-300, 1.0000001, 1e300};
    scene_make(SCENE_SPIKE, 1, &interval);
    rig r = rig_create(&interval, 1, NULL);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect_refused(&r, bad[i], 0.0, "min_separation is ");
    for (size_t i = 0; i < sizeof no_shares / sizeof *no_shares; i++)
        expect_refused(&r, 0.1, no_shares[i], "expected a share in (0,1]");
    cscd_detector_options defaults = cscd_detector_defaults();
    assert_true(defaults.min_separation == 0.0 && defaults.tolerance == 0.0);
    static const double good[] = {0x1p-300, 1e-30, 1.0, 0x1p300};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        cscd_detector_options options = options_within(good[i], CSCD_METHOD_NONE);
        rig fine = rig_create(&interval, 1, &options);
        rig_step(&fine, &interval);
        rig_destroy(&fine);
    }
    rig_destroy(&r);
}

/* The check of one moment looks for intersections only, with any options. */
TEST(the_static_check_is_not_concerned) {
    for (uint64_t seed = 0; seed < 4; seed++) {
        scene_make(SCENE_FOLDED_SHEET, seed, &interval);
        cscd_detector_options options = options_within(0.2, CSCD_METHOD_NONE);
        rig plain = rig_create(&interval, 1, NULL), wide = rig_create(&interval, 1, &options);
        cscd_intersections expected, found;
        expect_ok(check_packed(plain.detector, interval.x1, &expected));
        rig_step(&wide, &interval);
        expect_ok(check_packed(wide.detector, interval.x1, &found));
        assert_int_equal(found.count, expected.count);
        if (found.count > 0)
            assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
        rig_destroy(&wide);
        rig_destroy(&plain);
    }
}

/* A detector whose separation changes, to 0 and back, finds what new detectors find; a bad separation
 * changes nothing. */
TEST(separation_can_change) {
    static const double changes[] = {0.0, 0.03, 0.0, 0.2, 1e-3, 0.0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 5, &interval);
        cscd_detector_options options = options_within(0.0, CSCD_METHOD_SINGLE);
        rig changing = rig_create(&interval, 1, &options);
        for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
            expect_ok(cscd_detector_set_separation(changing.detector, changes[i], 0.0));
            assert_int_equal(cscd_detector_set_separation(changing.detector, -1.0, 0.0),
                             CSCD_INVALID_ARGUMENT);
            cscd_contacts found = rig_step(&changing, &interval);
            options = options_within(changes[i], CSCD_METHOD_SINGLE);
            rig fresh = rig_create(&interval, 1, &options);
            cscd_contacts expected = rig_step(&fresh, &interval);
            assert_int_equal(found.count, expected.count);
            if (found.count > 0)
                assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
            rig_destroy(&fresh);
        }
        rig_destroy(&changing);
    }
    assert_int_equal(cscd_detector_set_separation(NULL, 0.0, 0.0), CSCD_NULL_OBJECT);
}

/* A line search's candidates serve separations up to the one that it was begun with, or up to its reach; a
 * larger one is refused. */
TEST(lines_follow_what_they_can) {
    static const double changes[] = {0.0, 1e-3, 0.03, 0.2};
    static free_step_call call;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 6, &interval);
        cscd_detector_options options = options_within(family % 2 == 0 ? 0.03 : 0.0, CSCD_METHOD_SINGLE);
        rig r = rig_create(&interval, 1, &options);
        cscd_line_search *line = NULL;
        expect_ok(cscd_line_search_create(r.detector, &line));
        expect_ok(line_begin_packed(line, interval.x0, interval.x1, family % 2 == 0 ? 1e-3 : 0.03));
        for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
            options.min_separation = changes[i];
            expect_ok(cscd_detector_set_separation(r.detector, changes[i], 0.0));
            free_step_prepare(interval.x0, interval.x1, 1.0, options.step_factor, &call);
            call.status = line_max_step_packed(line, 1.0, call.end, &call.step);
            assert_true((call.status == CSCD_INVALID_ARGUMENT) == (changes[i] > 0.03));
            if (call.status == CSCD_INVALID_ARGUMENT) {
                assert_non_null(strstr(cscd_context_detail(r.context), "cscd_line_search_begin again"));
                continue;
            }
            rig reference = free_step_reference(&interval, &options);
            free_step_check(&reference, r.context, &call);
            rig_destroy(&reference);
        }
        cscd_line_search_destroy(line);
        rig_destroy(&r);
    }
}

static bool ignore_all(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return user == NULL && (kind == CSCD_CONTACT_VF || a < b);
}

/* A line search begins without separation and then goes with one through a pair that is ignored. What the
 * detector knew of the start must not be taken for its end. */
TEST(a_start_behind_a_wall_is_not_clean) {
    cscd_intersections crossing;
    cscd_contacts found;
    cscd_free_step step;
    size_t through = 0;
    for (uint64_t seed = 1; seed < 12; seed++) {
        scene_make(SCENE_SPIKE, seed, &interval);
        cscd_detector_options options = options_within(0.0, CSCD_METHOD_SINGLE);
        options.ignore = ignore_all;
        rig r = rig_create(&interval, 1, &options), plain = rig_create(&interval, 1, NULL);
        cscd_line_search *line = NULL;
        expect_ok(check_packed(plain.detector, interval.x1, &crossing));
        through += crossing.count > 0;
        bool embedded = crossing.count == 0;
        expect_ok(cscd_line_search_create(r.detector, &line));
        expect_ok(check_packed(r.detector, interval.x0, &crossing));
        expect_ok(line_begin_packed(line, interval.x0, interval.x1, 1e-6));
        expect_ok(cscd_detector_set_separation(r.detector, 1e-6, 0.0));
        expect_ok(line_max_step_packed(line, 1.0, NULL, &step));
        assert_false(step.limited);
        expect_ok(cscd_detector_set_separation(r.detector, 0.0, 0.0));
        expect_ok(step_packed(r.detector, interval.x1, interval.x1, &found));
        assert_true(embedded || !cscd_detector_guarantee(r.detector, 0).start_embedded);
        cscd_line_search_destroy(line);
        rig_destroy(&plain);
        rig_destroy(&r);
    }
    assert_true(through > 0);
}
