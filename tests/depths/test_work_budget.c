/* Depths that would take too much work are left out before it is done, and nothing else is; the work can be cancelled. */
#include "runtime/depths/deepest_points.h"
#include "runtime/detector/detector.h"
#include "runtime/detector/surface_answers.h"
#include "tests/support/intersections/answer_lists.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <string.h>

static body_rig rig, one_thread, without_depths, full; /* large */

static void make_tangle(body_rig *r, uint32_t threads) {
    tangle_add_shuffled(r, 5, 6);
    body_rig_create(r, NULL, threads);
}

static void find_with(body_rig *r, const cscd_intersection_options *options) {
    assert_int_equal(cscd_detector_find_intersections(
                         r->detector, CSCD_DOUBLES(r->all.x0, r->all.vertex_count), options, &r->found),
                     CSCD_OK);
}

/* Returns the options that ask for all. */
static cscd_intersection_options find_references(void) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.overlaps = options.cut_offs = options.parts = true;
    options.max_memory = 1 << 30;
    find_with(&without_depths, &options);
    options.depths = true;
    find_with(&full, &options);
    assert_int_equal(full.found.left_out, 0);
    return options;
}

/* Work that does not fit leaves out depths alone, the same for any number of threads; what is wanted is more, and
 * in the end enough. */
TEST(work_has_a_budget) {
    make_tangle(&rig, 3);
    make_tangle(&one_thread, 1);
    make_tangle(&without_depths, 1);
    make_tangle(&full, 1);
    cscd_intersection_options options = find_references();
    int rounds = 0;
    for (options.max_work = 1;; options.max_work = rig.found.wanted_work, rounds++) {
        find_with(&rig, &options);
        if (rig.found.left_out == 0) break;
        assert_int_equal(rig.found.left_out, 1 << CSCD_LEFT_OUT_DEPTHS);
        assert_int_equal(rig.found.wanted_memory, 0);
        assert_true(rig.found.wanted_work > options.max_work && rig.found.depths == NULL);
        compare_surfaces(rig.mesh, &without_depths.found, &rig.found);
        const uint64_t wanted = rig.found.wanted_work;
        find_with(&one_thread, &options);
        assert_int_equal(one_thread.found.wanted_work, wanted);
    }
    assert_true(rounds > 0);
    assert_int_equal(rig.found.wanted_work, 0);
    compare_surfaces(rig.mesh, &full.found, &rig.found);
}

/* Bodies in each other: a vertex asks of each body around it, which is more work than the mesh is large. */
TEST(searches_are_work) {
    enum { SHELLS = 20 };
    cscd_intersection_options options = cscd_intersection_defaults();
    options.depths = options.part_bodies = true;
    body_rig_begin(&rig);
    for (int i = 1; i <= SHELLS; i++) {
        const double low[3] = {-i, -i, -i}, size[3] = {2 * i, 2 * i, 2 * i};
        body_rig_add_box(&rig, low, size);
    }
    body_rig_end_body(&rig);
    body_rig_create(&rig, NULL, 1);
    for (int i = 0; i < 2; i++) {
        options.max_work = i == 0 ? 100000 : 1000000;
        find_with(&rig, &options);
        assert_int_equal(rig.found.left_out, i == 0 ? 1 << CSCD_LEFT_OUT_DEPTHS : 0);
    }
    assert_int_equal(rig.found.depths->vertex_count, 8 * SHELLS * (SHELLS - 1) / 2);
}

static bool count_report(void *user, const char *stage, double fraction) {
    (void)fraction;
    *(size_t *)user += strcmp(stage, "depths") == 0;
    return true;
}

/* The host is asked before every 16th question, before every group of triangles is opened, and before every fourth is looked at. */
TEST(the_host_is_asked_all_along) {
    size_t asked = 0;
    cscd_intersection_options options = cscd_intersection_defaults();
    options.depths = true;
    make_tangle(&rig, 1);
    rig.context->progress.host = (cscd_progress){count_report, &asked};
    rig.context->progress.interval_ms = 0.0;
    find_with(&rig, &options);
    const depth_finder *d = rig.detector->results.answers->depth_finder;
    const size_t groups = d->deepest.group_count, questions = d->question_count;
    assert_true(groups > 20 && questions > 16);
    assert_true(asked >= (questions + 15) / 16 + groups + (groups + 3) / 4);
}

AROUND_EACH(NULL, body_rigs_free)
