/* The published culling loses first contacts, which the detector's own rules do not (test_culling.c),
 * reports that it may, and culls nothing with a minimum separation. */
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

enum { INTERVALS_PER_FAMILY = 150, SEPARATED_INTERVALS_PER_FAMILY = 12 };

static scene interval; /* large; one test at a time */

static rig step_by(cscd_method method, double min_separation, cscd_contacts *found) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.ours = ours_of_method(method);
    options.min_separation = min_separation;
    rig r = rig_create(&interval, 1, &options);
    *found = rig_step(&r, &interval);
    return r;
}

TEST(first_contacts_are_lost) {
    uint32_t with_contact = 0, lost = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint32_t seed = 0; seed < INTERVALS_PER_FAMILY; seed++) {
            static double expected[COMPONENTS_MAX], times[COMPONENTS_MAX];
            cscd_contacts truth, found;
            scene_make((scene_family)family, seed + 1000, &interval);
            rig proven = step_by(CSCD_METHOD_SINGLE, 0.0, &truth);
            rig published = step_by(CSCD_METHOD_PUBLISHED, 0.0, &found);
            find_first_times(proven.mesh, &interval, &truth, expected);
            find_first_times(published.mesh, &interval, &found, times);
            for (uint32_t c = 0; c < cscd_mesh_component_count(proven.mesh); c++) {
                cscd_guarantee g = cscd_detector_guarantee(published.detector, c);
                const bool collapsed = cscd_detector_collapsed(published.detector, c);
                assert_false(g.complete);
                assert_int_equal(g.reason, collapsed ? CSCD_REASON_COLLAPSED : CSCD_REASON_PUBLISHED);
                if (isinf(expected[c]) || !cscd_detector_guarantee(proven.detector, c).start_embedded)
                    continue;
                with_contact++;
                lost += times[c] > expected[c] + TOI_EARLY;
            }
            rig_destroy(&proven);
            rig_destroy(&published);
        }
    }
    print_message("  %u of %u first contacts lost\n", lost, with_contact);
    assert_true(lost > 0);
}

/* When nothing is culled every contact is found, and the guarantee says so. */
TEST(nothing_is_culled_with_a_separation) {
    size_t contacts = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint32_t seed = 0; seed < SEPARATED_INTERVALS_PER_FAMILY; seed++) {
            cscd_contacts truth, found;
            scene_make((scene_family)family, seed, &interval);
            rig none = step_by(CSCD_METHOD_NONE, 0.03, &truth);
            rig published = step_by(CSCD_METHOD_PUBLISHED, 0.03, &found);
            assert_int_equal(found.count, truth.count);
            if (found.count > 0)
                assert_memory_equal(found.items, truth.items, found.count * sizeof *found.items);
            contacts += found.count;
            for (uint32_t c = 0; c < cscd_mesh_component_count(none.mesh); c++) {
                cscd_guarantee g = cscd_detector_guarantee(published.detector, c);
                assert_true(g.complete && g.reason == CSCD_REASON_METHOD);
            }
            rig_destroy(&none);
            rig_destroy(&published);
        }
    }
    assert_true(contacts > 1000);
}

/* A method that loses contacts certifies no step. */
TEST(no_step_is_certified) {
    static const cscd_method methods[] = {CSCD_METHOD_PUBLISHED, CSCD_METHOD_ICCD_PUBLISHED};
    scene_make(SCENE_TWO_SPHERES, 1, &interval);
    for (int i = 0; i < 2; i++) {
        cscd_contacts found;
        cscd_free_step out = {.fraction = -1.0};
        rig r = step_by(methods[i], 0.0, &found);
        assert_int_equal(max_step_packed(r.detector, interval.x0, interval.x1, NULL, &out),
                         CSCD_INVALID_ARGUMENT);
        assert_non_null(strstr(cscd_context_detail(r.context), cscd_method_name(methods[i])));
        assert_true(out.fraction == -1.0);
        rig_destroy(&r);
    }
}

/* Without this, the tests here would pass in a build without baselines. */
TEST(baselines_are_present) {
    static const cscd_method methods[] = {CSCD_METHOD_PUBLISHED, CSCD_METHOD_ICCD,
                                          CSCD_METHOD_ICCD_PUBLISHED};
    for (int i = 0; i < 3; i++) assert_int_equal(method_or_none(methods[i]), methods[i]);
}
