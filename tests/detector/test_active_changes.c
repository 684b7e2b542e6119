/* Active vertices while trees are built again, meshes change, and detectors are cloned. */
#include "cscd/cscd.h"
#include "tests/support/active_twins.h"
#include "tests/support/calls.h"
#include "tests/support/moving_scene.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static active_twins twins; /* large, as the others; one test at a time */
static scene s;

/* ---- what becomes of the set --------------------------------------------------------------------------- */

enum { BALLS = 60 };

/* Balls that jump about between steps, so that trees are built again. Every third one rests, but for some of its vertices. */
TEST(rebuilt_trees_have_the_set) {
    static double next[SCENE_VERTICES_MAX * 3];
    double jump[3] = {0, 0, 0}, shift[3] = {0, 0, 0};
    random_stream random = stream_start(4);
    size_t rebuilds = 0;
    scene_clear(&s);
    for (int i = 0; i < BALLS; i++) scene_add_sphere(&s, (double[3]){0.3 * i, 0, 0}, 0.2, 3, 4);
    const uint32_t each = s.vertex_count / BALLS;
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.02;
    rig r = rig_create(&s, 2, &options);
    memset(&twins, 0, sizeof twins);
    active_twins_begin(&twins, r.detector, &options, false);
    twins.set = true;
    for (uint32_t v = 0; v < s.vertex_count; v++) twins.active[v] = v / each % 3 > 0 || v % 7 == 0;
    active_twins_tell(&twins);
    for (int step = 0; step < 36; step++) {
        for (uint32_t v = 0; v < s.vertex_count; v++) {
            for (uint32_t k = 0; k < 3; k++) {
                if (v % each == 0)
                    jump[k] = step < 2 ? 0.0 : stream_between(&random, -1.5, 1.5) - s.x0[v * 3 + k];
                if (v % each == 0) shift[k] = stream_between(&random, -0.2, 0.2);
                s.x0[v * 3 + k] += jump[k];
                next[v * 3 + k] = s.x0[v * 3 + k] + shift[k];
            }
        }
        active_twins_hold(&twins, s.x0, next);
        active_twins_step(&twins, s.x0, next);
        cscd_counters ours = cscd_detector_counters(r.detector), all = cscd_detector_counters(twins.theirs);
        assert_int_equal(ours.rebuilds, all.rebuilds);
        assert_true(ours.boxes_tested < all.boxes_tested);
        rebuilds += ours.rebuilds;
    }
    print_message("%zu rebuilds, %zu contacts, %zu left out\n", rebuilds, twins.contacts, twins.left_out);
    assert_true(rebuilds > 0 && twins.contacts > 1000 && twins.left_out > 100);
    active_twins_end(&twins);
    rig_destroy(&r);
}

/* The set after a change: what comes from an active vertex, and what is new. */
static void map_set(void) {
    static bool before[TWIN_VERTICES_MAX];
    uint32_t count;
    const uint32_t *origins = cscd_mesh_change_to_old(moving.last, CSCD_VERTICES, &count);
    memcpy(before, twins.active, sizeof before);
    for (uint32_t v = 0; v < count; v++) twins.active[v] = origins[v] == UINT32_MAX || before[origins[v]];
}

static void change_both(size_t *told) {
    cscd_detector *theirs = twins.theirs;
    moving_change_scene();
    map_set();
    expect_ok(cscd_detector_change_mesh(theirs, moving.last));
    active_twins_join(&twins, moving.detector, theirs);
    if (stream_below(&moving.random, 4) > 0) return;
    active_twins_choose(&twins, moving_joined.x0, &moving.random);
    ++*told;
}

static void run_changes(cscd_context *context, uint64_t seed, size_t *told) {
    moving_begin_scene(context, seed, false);
    moving.options.ignore = active_twins_ignore;
    moving.options.ignore_user = &twins;
    cscd_detector *theirs = moving_new_detector(moving_mesh_now(), NULL);
    active_twins_join(&twins, moving.detector, theirs);
    active_twins_choose(&twins, moving_joined.x0, &moving.random);
    for (int i = 0; i < 8; i++) {
        moving_move_scene(0.2);
        active_twins_hold(&twins, moving.x0, moving.x1);
        if (moving.earliest)
            active_twins_check(&twins, moving.x0);
        else
            active_twins_step(&twins, moving.x0, moving.x1);
        active_twins_near(&twins, moving.x1, 0.05);
        moving_go_on();
        uint32_t next = stream_below(&moving.random, 3);
        if (next == 0) moving_replace_by_clone();
        twins.ours = moving.detector;
        if (next == 1) change_both(told);
    }
    active_twins_end(&twins);
    moving_end_scene();
}

TEST(clones_and_changed_meshes_keep_the_set) {
    cscd_context *context = context_of(0, NULL);
    size_t told = 0;
    memset(&twins, 0, sizeof twins);
    for (uint64_t seed = 0; seed < 24; seed++) run_changes(context, seed, &told);
    cscd_context_destroy(context);
    print_message("changes: %zu contacts, %zu near, %zu left out, %zu waiting, told %zu times\n",
                  twins.contacts, twins.near, twins.left_out, twins.waiting, told);
    assert_true(twins.contacts > 300 && twins.near > 300 && twins.left_out > 300 && told > 3);
}
