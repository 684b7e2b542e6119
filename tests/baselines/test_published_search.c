/* The published search against the detector's own: without culling it finds the same contacts, bit for bit; with all steps ours it loses
 * no first contact; each step alone is what it says. */
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

enum { INTERVALS_PER_FAMILY = PACED(60, 8) };

static const uint64_t every_step = CSCD_OURS_MOTION | CSCD_OURS_STARTS | CSCD_OURS_REPRESENTATIVES |
                                   CSCD_OURS_NEIGHBOURS | CSCD_OURS_TESTS | CSCD_OURS_BOXES;

static scene interval; /* large; one test at a time */

/* A detector after one step. */
typedef struct outcome {
    rig objects;
    cscd_contacts found;
    cscd_counters counters;
} outcome;

static outcome step_by(cscd_method method, uint64_t ours, size_t longest_list) {
    outcome out;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.ours = ours;
    options.longest_list = longest_list;
    out.objects = rig_create(&interval, 1, &options);
    out.found = rig_step(&out.objects, &interval);
    out.counters = cscd_detector_counters(out.objects.detector);
    return out;
}

static void expect_same(const cscd_contacts *found, const cscd_contacts *truth) {
    assert_int_equal(found->count, truth->count);
    if (truth->count > 0)
        assert_memory_equal(found->items, truth->items, truth->count * sizeof *truth->items);
}

/* A sheet is not culled: adjacent triangles are tested, and the first triangles at two features test them, so nothing is lost. */
TEST(nothing_is_lost_where_nothing_is_culled) {
    const uint64_t tested = CSCD_OURS_NEIGHBOURS | CSCD_OURS_TESTS;
    size_t contacts = 0;
    for (uint32_t seed = 0; seed < INTERVALS_PER_FAMILY; seed++) {
        scene_make(SCENE_FOLDED_SHEET, seed, &interval);
        outcome truth = step_by(CSCD_METHOD_NONE, 0, 0);
        for (int i = 0; i < 4; i++) {
            const uint64_t more = (i & 1 ? CSCD_OURS_BOXES : 0) | (i & 2 ? CSCD_OURS_REPRESENTATIVES : 0);
            outcome published =
                step_by(CSCD_METHOD_PUBLISHED, tested | more, i == 3 ? truth.found.count + 1 : 0);
            expect_same(&published.found, &truth.found);
            rig_destroy(&published.objects);
        }
        contacts += truth.found.count;
        rig_destroy(&truth.objects);
    }
    assert_true(contacts > 50);
}

/* With all steps ours, of what starts embedded no first contact is lost: culling by orientation as in the theory, without closing passes. */
TEST(our_steps_lose_no_first_contact) {
    uint32_t with_contact = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint32_t seed = 0; seed < INTERVALS_PER_FAMILY; seed++) {
            static double expected[COMPONENTS_MAX], times[COMPONENTS_MAX];
            scene_make((scene_family)family, seed + 1000, &interval);
            outcome proven = step_by(CSCD_METHOD_SINGLE, 0, 0),
                    ours = step_by(CSCD_METHOD_PUBLISHED, every_step, 0);
            find_first_times(proven.objects.mesh, &interval, &proven.found, expected);
            find_first_times(ours.objects.mesh, &interval, &ours.found, times);
            for (uint32_t c = 0; c < cscd_mesh_component_count(proven.objects.mesh); c++) {
                if (isinf(expected[c])) continue;
                if (!cscd_detector_guarantee(proven.objects.detector, c).start_embedded) continue;
                with_contact++;
                assert_true(times[c] <= expected[c] + TOI_EARLY);
            }
            rig_destroy(&proven.objects);
            rig_destroy(&ours.objects);
        }
    }
    assert_true(with_contact > PACED(20, 1));
}

/* Each step has its own effect: neighbours add pairs, proofs are made, 14-DOPs leave fewer pairs than boxes. */
TEST(each_step_alone) {
    uint64_t proofs[2] = {0}, pairs[2] = {0}, adjacent[2] = {0}, boxes[2] = {0};
    for (uint32_t seed = 0; seed < 20; seed++) {
        scene_make(SCENE_BENT_CAPSULE, seed, &interval);
        const uint64_t steps[] = {0, CSCD_OURS_STARTS, CSCD_OURS_NEIGHBOURS, CSCD_OURS_BOXES};
        for (int i = 0; i < 4; i++) {
            outcome out = step_by(CSCD_METHOD_PUBLISHED, steps[i] | CSCD_OURS_TESTS, 0);
            if (i < 2) proofs[i] += out.counters.static_checks;
            if (i == 0) adjacent[0] += out.counters.adjacent;
            if (i == 2) adjacent[1] += out.counters.adjacent;
            if (i == 0) boxes[0] += out.counters.pcp - out.counters.adjacent;
            if (i == 3) boxes[1] += out.counters.pcp - out.counters.adjacent;
            if (i == 0) pairs[0] += out.counters.feature_pairs;
            if (i == 2) pairs[1] += out.counters.feature_pairs;
            assert_true(out.counters.boxes_tested > 0 && out.counters.plus > 0);
            rig_destroy(&out.objects);
        }
    }
    assert_true(proofs[0] == 0 && proofs[1] == 20);
    assert_true(adjacent[0] > 0 && adjacent[1] == 0 && pairs[1] > pairs[0]);
    assert_true(boxes[0] < boxes[1]);
}

/* Detector points stay where they are at the start, or move with their regions. */
TEST(points_stay_or_move) {
    scene_make(SCENE_TWO_SPHERES, 3, &interval);
    for (int moves = 0; moves < 2; moves++) {
        outcome out = step_by(CSCD_METHOD_PUBLISHED, CSCD_OURS_TESTS | (moves ? CSCD_OURS_MOTION : 0), 0);
        outcome single = step_by(CSCD_METHOD_SINGLE, 0, 0);
        double start[3], end[3], ours[2][3];
        cscd_detector_region_point(out.objects.detector, 0, start, end);
        cscd_detector_region_point(single.objects.detector, 0, ours[0], ours[1]);
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(start[k] - ours[0][k]) < 1e-6);
            assert_true(fabs(end[k] - ours[moves][k]) < 1e-6);
        }
        assert_int_equal(memcmp(start, end, sizeof start) == 0, moves == 0);
        rig_destroy(&out.objects);
        rig_destroy(&single.objects);
    }
}

/* A list that becomes too long says how many contacts there are, and the search goes on from where it was. */
TEST(lists_have_a_most) {
    for (uint32_t seed = 0; seed < 10; seed++) {
        scene_make(SCENE_FOLDED_SHEET, seed, &interval);
        outcome all = step_by(CSCD_METHOD_PUBLISHED, CSCD_OURS_TESTS | CSCD_OURS_NEIGHBOURS, 0);
        if (all.found.count > 1) {
            cscd_detector_options options = cscd_detector_defaults();
            cscd_contacts found;
            options.method = CSCD_METHOD_PUBLISHED;
            options.ours = CSCD_OURS_TESTS | CSCD_OURS_NEIGHBOURS;
            options.longest_list = 1;
            rig r = rig_create(&interval, 1, &options);
            assert_int_equal(step_packed(r.detector, interval.x0, interval.x1, &found), CSCD_LIST_TOO_LONG);
            assert_int_equal(found.count, all.found.count);
            rig_destroy(&r);
        }
        rig_destroy(&all.objects);
    }
}

TEST(steps_belong_to_methods) {
    static const struct {
        cscd_method method;
        uint64_t ours;
    } refused[] = {{CSCD_METHOD_CHARGE, CSCD_OURS_TESTS},
                   {CSCD_METHOD_SINGLE, CSCD_OURS_BOXES},
                   {CSCD_METHOD_PUBLISHED, CSCD_OURS_CHARGE},
                   {CSCD_METHOD_ICCD_PUBLISHED, CSCD_OURS_MOTION},
                   {CSCD_METHOD_PUBLISHED, 1u << 20}};
    scene_make(SCENE_TWO_SPHERES, 1, &interval);
    for (int i = 0; i < 5; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        cscd_detector *detector = NULL;
        rig r = rig_create(&interval, 1, NULL);
        options.method = refused[i].method;
        options.ours = refused[i].ours;
        expect_invalid(r.context, cscd_detector_create(r.context, r.mesh, NULL, &options, &detector),
                       "ours has steps");
        rig_destroy(&r);
    }
}
