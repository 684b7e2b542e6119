/* Methods iccd and cones find the contacts of method none, bit for bit, on random intervals and with all options; as
 * published, iccd loses some. */
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <string.h>

enum { INTERVALS_PER_FAMILY = PACED(200, 25) };

enum { BRUTE_EVERY = 25, OPTIONS_EVERY = 5 };

static const cscd_method proven[] = {CSCD_METHOD_ICCD, CSCD_METHOD_CONES};

enum { PROVEN_COUNT = sizeof proven / sizeof *proven };

static scene interval; /* large; one test at a time */

/* The result of a detector. */
typedef struct iccd_outcome {
    rig objects;
    cscd_contacts contacts;
    cscd_counters counters;
} iccd_outcome;

static iccd_outcome run_method(cscd_detector_options options, cscd_method method, uint32_t threads) {
    iccd_outcome out;
    options.method = method;
    options.ours = ours_of_method(method);
    out.objects = rig_create(&interval, threads, &options);
    out.contacts = rig_step(&out.objects, &interval);
    out.counters = cscd_detector_counters(out.objects.detector);
    return out;
}

static void check_same(const cscd_contacts *found, const cscd_contacts *truth) {
    assert_int_equal(found->count, truth->count);
    if (truth->count > 0)
        assert_memory_equal(found->items, truth->items, truth->count * sizeof *truth->items);
}

/* Checks that the list of the method is that of none. */
static iccd_outcome expect_same(cscd_detector_options options, cscd_method method, uint32_t threads,
                                const cscd_contacts *truth) {
    iccd_outcome out = run_method(options, method, threads);
    check_same(&out.contacts, truth);
    return out;
}

typedef struct iccd_tally {
    uint64_t contacts, pairs_without, intervals_published_loses, lost;
    uint64_t contours[PROVEN_COUNT], sealed[PROVEN_COUNT], pairs[PROVEN_COUNT];
} iccd_tally;

static void add_tally(iccd_tally *sum, const iccd_tally *t) {
    sum->contacts += t->contacts;
    sum->pairs_without += t->pairs_without;
    sum->intervals_published_loses += t->intervals_published_loses;
    sum->lost += t->lost;
    for (int m = 0; m < PROVEN_COUNT; m++) {
        sum->contours[m] += t->contours[m];
        sum->sealed[m] += t->sealed[m];
        sum->pairs[m] += t->pairs[m];
    }
}

static void print_tally(const char *name, const iccd_tally *t) {
    print_message("  %-14s %7llu contacts; as published %6llu lost, in %3llu intervals\n", name,
                  (unsigned long long)t->contacts, (unsigned long long)t->lost,
                  (unsigned long long)t->intervals_published_loses);
    for (int m = 0; m < PROVEN_COUNT; m++)
        print_message("    %-12s %7llu contours tested, %6llu patches sealed; pairs %5.1f %%\n",
                      cscd_method_name(proven[m]), (unsigned long long)t->contours[m],
                      (unsigned long long)t->sealed[m],
                      100.0 * (double)t->pairs[m] / (double)t->pairs_without);
}

/* Checks that the published list is a part of the truth. Returns how many contacts are missing. */
static uint64_t count_lost(const cscd_contacts *found, const cscd_contacts *truth) {
    size_t next = 0;
    for (size_t i = 0; i < truth->count && next < found->count; i++)
        next += memcmp(&found->items[next], &truth->items[i], sizeof *truth->items) == 0;
    assert_int_equal(next, found->count);
    return truth->count - found->count;
}

static void run_interval(uint32_t seed, iccd_tally *sum) {
    cscd_detector_options options = cscd_detector_defaults();
    iccd_outcome none = run_method(options, CSCD_METHOD_NONE, 1);
    iccd_outcome published = run_method(options, CSCD_METHOD_ICCD_PUBLISHED, 1);
    if (seed % BRUTE_EVERY == 0) {
        iccd_outcome brute = expect_same(options, CSCD_METHOD_BRUTE, 1, &none.contacts);
        rig_destroy(&brute.objects);
    }
    uint64_t lost = count_lost(&published.contacts, &none.contacts);
    iccd_tally own = {.contacts = none.contacts.count,
                      .pairs_without = none.counters.pcp,
                      .intervals_published_loses = lost > 0,
                      .lost = lost};
    for (int m = 0; m < PROVEN_COUNT; m++) {
        iccd_outcome found = expect_same(options, proven[m], 1, &none.contacts);
        assert_true(found.counters.pcp <= none.counters.pcp);
        own.contours[m] = found.counters.contours;
        own.sealed[m] = found.counters.sealed;
        own.pairs[m] = found.counters.pcp;
        rig_destroy(&found.objects);
    }
    add_tally(sum, &own);
    rig_destroy(&none.objects);
    rig_destroy(&published.objects);
}

TEST(contacts_equal_those_of_none) {
    iccd_tally sum = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        iccd_tally own = {0};
        for (uint32_t seed = 0; seed < INTERVALS_PER_FAMILY; seed++) {
            scene_make((scene_family)family, seed + 30000, &interval);
            run_interval(seed, &own);
        }
        print_tally(scene_family_name((scene_family)family), &own);
        add_tally(&sum, &own);
    }
    print_tally("all", &sum);
    assert_true(sum.contacts > 0 && sum.lost > 0);
    for (int m = 0; m < PROVEN_COUNT; m++)
        assert_true(sum.sealed[m] > 0 && 10 * sum.pairs[m] < 9 * sum.pairs_without);
    assert_true(100 * sum.pairs[1] <= 103 * sum.pairs[0]); /* ears leave little to the sweep */
}

/* ---- options and repeated steps -------------------------------------------------------------------- */

static bool ignore_some(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)user;
    (void)kind;
    return (a * 2654435761u ^ b * 40503u) % 3 == 0;
}

/* Several threads and ignored pairs change no contact, in mode earliest neither; with a separation nothing is culled. */
static void change_options(cscd_method method) {
    size_t kept = 0, near = 0;
    for (uint32_t seed = 0; seed < INTERVALS_PER_FAMILY * SCENE_FAMILY_COUNT; seed += OPTIONS_EVERY) {
        cscd_detector_options options = cscd_detector_defaults();
        scene_make((scene_family)(seed % SCENE_FAMILY_COUNT), seed + 40000, &interval);
        iccd_outcome none = run_method(options, CSCD_METHOD_NONE, 1);
        iccd_outcome threaded = expect_same(options, method, 4, &none.contacts);
        options.mode = CSCD_MODE_EARLIEST;
        iccd_outcome first = run_method(options, CSCD_METHOD_NONE, 1);
        iccd_outcome earliest = expect_same(options, method, 1, &first.contacts);
        assert_int_equal(threaded.counters.pcp, earliest.counters.pcp);
        assert_int_equal(threaded.counters.boxes_tested, earliest.counters.boxes_tested);
        options.ignore = ignore_some;
        iccd_outcome some = run_method(options, CSCD_METHOD_NONE, 1);
        iccd_outcome some_found = expect_same(options, method, 1, &some.contacts);
        kept += some.contacts.count;
        iccd_outcome *done[] = {&none, &threaded, &first, &earliest, &some, &some_found};
        for (int i = 0; i < 6; i++) rig_destroy(&done[i]->objects);
        if (seed % (8 * OPTIONS_EVERY) != 0) continue;
        options = cscd_detector_defaults();
        options.min_separation = 0.01;
        none = run_method(options, CSCD_METHOD_NONE, 1);
        iccd_outcome apart = expect_same(options, method, 1, &none.contacts);
        assert_int_equal(apart.counters.pcp, none.counters.pcp);
        assert_int_equal(apart.counters.contours, 0);
        assert_int_equal(cscd_detector_guarantee(apart.objects.detector, 0).reason, CSCD_REASON_METHOD);
        near += none.contacts.count;
        rig_destroy(&none.objects);
        rig_destroy(&apart.objects);
    }
    assert_true(kept > 0 && near > 0);
}

TEST(options_change_nothing) {
    for (int m = 0; m < PROVEN_COUNT; m++) change_options(proven[m]);
}

/* A detector follows a motion there and back. Patches belong to the mesh, and all else to one interval
 * only. */
static void step_to_and_fro(cscd_method method) {
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        cscd_detector_options options = cscd_detector_defaults();
        scene_make((scene_family)family, 50000, &interval);
        iccd_outcome none = run_method(options, CSCD_METHOD_NONE, 1), other = run_method(options, method, 1);
        const double *ends[4] = {interval.x1, interval.x0, interval.x0, interval.x1};
        const double *x = interval.x0;
        uint64_t sealed = 0;
        for (int i = 0; i < 4; i++) {
            cscd_contacts expected, found;
            assert_int_equal(step_packed(none.objects.detector, x, ends[i], &expected), CSCD_OK);
            assert_int_equal(step_packed(other.objects.detector, x, ends[i], &found), CSCD_OK);
            check_same(&found, &expected);
            if (i == 0) sealed = cscd_detector_counters(other.objects.detector).sealed;
            if (i == 3) assert_int_equal(cscd_detector_counters(other.objects.detector).sealed, sealed);
            x = ends[i];
        }
        rig_destroy(&none.objects);
        rig_destroy(&other.objects);
    }
}

TEST(steps_do_not_remember) {
    for (int m = 0; m < PROVEN_COUNT; m++) step_to_and_fro(proven[m]);
}

/* Small squares that have changed places: after some steps their trees are replaced, and the patches of the old ones with them. */
static void replace_trees(cscd_method method) {
    enum { SQUARES = 64, STEPS = 40 };
    static const uint32_t halves[6] = {0, 1, 2, 2, 1, 3};
    cscd_detector_options options = cscd_detector_defaults();
    uint64_t sealed = 0;
    scene_clear(&interval);
    interval.triangle_count = 2 * SQUARES;
    interval.vertex_count = 4 * SQUARES;
    for (uint32_t i = 0; i < 6 * SQUARES; i++) interval.triangles[i] = i / 6 * 4 + halves[i % 6];
    options.method = method;
    rig r = {NULL};
    for (uint32_t step = 0; step < STEPS; step++) {
        cscd_contacts found;
        for (uint32_t v = 0; v < 4 * SQUARES; v++) {
            const uint32_t place =
                step == 0 ? v / 4 : v / 4 * 29 % SQUARES; /* 29 and 64 have no divisor in common */
            const double x[3] = {place % 8 + 0.1 * (v % 2), place / 8 + 0.1 * (v / 2 % 2), 0.0};
            memcpy(interval.x0 + 3 * v, x, sizeof x);
            memcpy(interval.x1 + 3 * v, x, sizeof x);
            interval.x1[3 * v + 2] += 0.4 * (place % 3);
        }
        if (step == 0) r = rig_create(&interval, 1, &options);
        assert_int_equal(step_packed(r.detector, interval.x0, interval.x1, &found), CSCD_OK);
        assert_int_equal(found.count, 0);
        sealed += cscd_detector_counters(r.detector).sealed;
    }
    assert_true(sealed > 0);
    rig_destroy(&r);
}

TEST(patches_follow_their_trees) {
    for (int m = 0; m < PROVEN_COUNT; m++) replace_trees(proven[m]);
}

/* Scaling by a power of two changes nothing while squares stay in range; beyond that nothing is sealed and
 * nothing lost. */
static void scale_scenes(cscd_method method) {
    static const double scales[] = {0x1p-230, 0x1p-100, 0x1p100, 0x1p240, 0x1p-280, 0x1p285};
    for (uint32_t seed = 0; seed < SCENE_FAMILY_COUNT; seed++) {
        cscd_detector_options options = cscd_detector_defaults();
        scene_make((scene_family)seed, seed + 60000, &interval);
        for (uint32_t i = 0; i < interval.vertex_count * 3; i++) { /* is 0, or far from the least magnitude */
            interval.x0[i] = (double)(float)interval.x0[i] + 0.0;
            interval.x1[i] = (double)(float)interval.x1[i] + 0.0;
            if (interval.x0[i] < 1e-3 && interval.x0[i] > -1e-3) interval.x0[i] = 0.0;
            if (interval.x1[i] < 1e-3 && interval.x1[i] > -1e-3) interval.x1[i] = 0.0;
        }
        scene original = interval;
        iccd_outcome plain = run_method(options, method, 1);
        for (size_t k = 0; k < sizeof scales / sizeof *scales; k++) {
            for (uint32_t i = 0; i < interval.vertex_count * 3; i++) {
                interval.x0[i] = original.x0[i] * scales[k];
                interval.x1[i] = original.x1[i] * scales[k];
            }
            iccd_outcome none = run_method(options, CSCD_METHOD_NONE, 1);
            iccd_outcome scaled = expect_same(options, method, 1, &none.contacts);
            assert_int_equal(scaled.counters.sealed, k < 4 ? plain.counters.sealed : 0);
            rig_destroy(&none.objects);
            rig_destroy(&scaled.objects);
        }
        rig_destroy(&plain.objects);
    }
}

TEST(scales_change_nothing) {
    for (int m = 0; m < PROVEN_COUNT; m++) scale_scenes(proven[m]);
}

/* ---- guarantees ------------------------------------------------------------------------------------ */

TEST(guarantees_say_how) {
    for (uint32_t family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 70000, &interval);
        for (int i = 0; i < 2 * PROVEN_COUNT; i++) {
            cscd_detector_options options = cscd_detector_defaults();
            const cscd_mode mode = i % 2 == 0 ? CSCD_MODE_ALL : CSCD_MODE_EARLIEST;
            options.mode = mode;
            iccd_outcome iccd = run_method(options, proven[i / 2], 1);
            iccd_outcome published = run_method(options, CSCD_METHOD_ICCD_PUBLISHED, 1);
            for (uint32_t c = 0; c < cscd_mesh_component_count(iccd.objects.mesh); c++) {
                cscd_guarantee g = cscd_detector_guarantee(iccd.objects.detector, c);
                bool later = g.reason == CSCD_REASON_EARLIEST; /* contacts are missing */
                assert_true(g.complete != later && (mode == CSCD_MODE_EARLIEST || !later));
                if (!later) assert_int_equal(g.reason, CSCD_REASON_CONTOUR);
                g = cscd_detector_guarantee(published.objects.detector, c);
                assert_false(g.complete);
                assert_int_equal(g.reason, CSCD_REASON_PUBLISHED);
            }
            rig_destroy(&iccd.objects);
            rig_destroy(&published.objects);
        }
    }
    assert_string_equal(cscd_method_name(CSCD_METHOD_ICCD), "iccd");
    assert_string_equal(cscd_method_name(CSCD_METHOD_CONES), "cones");
    cscd_method method = CSCD_METHOD_AUTO;
    assert_true(cscd_from_name(CSCD_METHODS, "iccd-published", (uint32_t *)&method) &&
                method == CSCD_METHOD_ICCD_PUBLISHED);
}
