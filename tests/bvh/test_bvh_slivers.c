/* Slivers side by side, and large triangles on each other: the same answers as of all pairs, and in near-linear time. */
#include "models/shapes/extreme_shapes.h"
#include "src/mesh/mesh.h"
#include "src/mesh/predicates.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SLIVERS = HUB_TRIANGLES + 20, SEEDS = 4 };

static scene shape; /* large; one test at a time */

/* Slivers about along a direction, or sheets on each other; all move, turn, and some come near each other. */
static void make_motion(uint64_t seed) {
    random_stream random = stream_start(seed);
    const bool flat = seed % 2 == 1;
    const double spread = stream_between(&random, 0.5, 2.0), turn = stream_between(&random, 0.0, 0.2);
    scene_clear(&shape);
    shape.vertex_count = 3 * SLIVERS;
    shape.triangle_count = SLIVERS;
    for (uint32_t v = 0; v < 3 * SLIVERS; v++) {
        double *p = shape.x0 + 3 * v, *q = shape.x1 + 3 * v;
        const uint32_t triangle = v / 3, corner = v % 3;
        const double across = triangle / (double)SLIVERS, far = corner == 2 ? 1.0 : 0.0,
                     wide = corner == 1 ? 0.3 : 0.0;
        p[0] = flat ? far : across + far + wide / SLIVERS;
        p[1] = flat ? (corner == 1 ? 1.0 : 0.0) : far - across;
        p[2] = flat ? 1e-6 * triangle : far;
        for (int k = 0; k < 3; k++) {
            p[k] += stream_between(&random, -1.0, 1.0) * (flat ? 1e-6 : spread / SLIVERS);
            q[k] = p[k] + stream_between(&random, -1.0, 1.0) * (flat ? 1e-6 : 3.0 * spread / SLIVERS);
        }
        q[2] += 0.5 * (double)seed + turn * p[0];
        shape.triangles[v] = v;
    }
}

static size_t compare_step(const oracle_list *truth, const cscd_detector_options *options) {
    rig r = rig_create(&shape, 1, options);
    const cscd_contacts found = rig_step(&r, &shape);
    oracle_expect(truth, &found);
    rig_destroy(&r);
    return truth->count;
}

TEST(contacts_equal_brute_force) {
    oracle_list truth = {0};
    size_t contacts = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        cscd_detector_options options = cscd_detector_defaults();
        make_motion(seed);
        oracle_find(&shape, &truth);
        contacts += compare_step(&truth, &options);
        print_message("  %zu contacts\n", truth.count);
    }
    assert_true(contacts > 1000);
    oracle_free(&truth);
}

TEST(distances_equal_brute_force) {
    oracle_list truth = {0};
    size_t contacts = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const double distance = seed % 2 == 1 ? 3e-6 : 2.0 / SLIVERS;
        cscd_detector_options options = cscd_detector_defaults();
        const separation limit = {distance, 1e-6 * distance};
        options.min_separation = limit.distance;
        make_motion(seed);
        for (uint32_t i = 0; i < 9 * SLIVERS; i++)
            shape.x1[i] = shape.x0[i] + 0.25 * (shape.x1[i] - shape.x0[i]);
        oracle_find_within(&shape, &limit, &truth);
        contacts += compare_step(&truth, &options);
        print_message("  %zu pairs within the distance\n", truth.count);
    }
    assert_true(contacts > 1000);
    oracle_free(&truth);
}

TEST(intersections_equal_all_pairs) {
    const uint32_t(*t)[3] = (const uint32_t(*)[3])shape.triangles;
    size_t pairs = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        size_t expected = 0;
        cscd_intersections found;
        make_motion(seed);
        rig r = rig_create(&shape, 1, NULL);
        for (uint32_t a = 0; a < SLIVERS; a++)
            for (uint32_t b = 0; b < a; b++) expected += triangles_intersect(t[a], t[b], shape.x1);
        assert_int_equal(check_packed(r.detector, shape.x1, &found), CSCD_OK);
        assert_int_equal(found.count, expected);
        pairs += expected;
        rig_destroy(&r);
    }
    print_message("  %zu pairs intersect\n", pairs);
    assert_true(pairs > 100);
}

/* ---- cost ------------------------------------------------------------------------------------------------ */

static cscd_counters count_step(extreme_kind kind, uint32_t count) {
    extreme_shape s = extreme_shape_make(kind, count);
    cscd_contacts found;
    const cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    rig r = rig_of_objects(context_of(0, NULL), &desc, 1, NULL, NULL);
    assert_int_equal(step_packed(r.detector, s.x0, s.x1, &found), CSCD_OK);
    assert_int_equal(found.count, 0);
    const cscd_counters counters = cscd_detector_counters(r.detector);
    rig_destroy(&r);
    extreme_shape_free(&s);
    return counters;
}

TEST(four_times_the_triangles_take_no_sixteenfold) {
    static const extreme_kind kinds[] = {EXTREME_SLIVERS, EXTREME_PILE};
    for (int k = 0; k < 2; k++) {
        const cscd_counters few = count_step(kinds[k], 1000), many = count_step(kinds[k], 4000);
        print_message("  %s: %.0f and %.0f pairs of volumes, %.0f and %.0f of features\n",
                      extreme_kind_name(kinds[k]), (double)few.boxes_tested, (double)many.boxes_tested,
                      (double)few.tests, (double)many.tests);
        assert_true(many.boxes_tested < 6 * few.boxes_tested);
        assert_true(many.tests <= 6 * few.tests);
    }
}
