/* A failed call restores what it has changed, and a snapshot is taken only for calls that can be
 * cancelled. */
#include "runtime/detector/detector.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static scene shape; /* large; one test at a time */

static bool go_on(void *user, const char *stage, double fraction) {
    (void)user;
    (void)stage;
    (void)fraction;
    return true;
}

/* Saves, changes everything that a call may change, and restores. Returns whether all is as before. */
static bool comes_back(bool cancellable) {
    cscd_context_options options = cscd_context_defaults();
    if (cancellable) options.progress.report = go_on;
    cscd_context *context = NULL;
    scene_make(SCENE_TWO_SPHERES, 1, &shape);
    expect_ok(cscd_context_create(&options, &context));
    cscd_mesh *mesh = mesh_of_scene(context, &shape);
    start_states s;
    rollback r = {.triangles = NULL};
    bvh_rebuild trees = {.intervals_unmeasured = 7};
    expect_ok(start_states_create(mesh, &s));
    expect_ok(rollback_create(mesh, &r));
    memset(s.triangles, TRIANGLE_CLEAN, shape.triangle_count);
    s.of[1].pause = 4;
    s.vouched = true;
    rollback_save(&r, &s, &trees); /* nothing is counted yet */

    start_states_taint(&s, 3);
    start_states_count(&s);
    s.of[1].pause = 3;
    s.vouched = false;
    trees.intervals_unmeasured = 8;
    rollback_restore(&r, &s, &trees);
    start_states_count(&s);
    bool same = s.triangles[3] == TRIANGLE_CLEAN && s.of[1].pause == 4 && s.vouched &&
                trees.intervals_unmeasured == 7 && s.of[0].unknown == 0 &&
                s.of[0].clean == mesh->components[0].triangle_count;
    rollback_free(context, &r);
    start_states_destroy(&s);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return same;
}

TEST(a_call_that_can_be_cancelled_is_undone) {
    assert_true(comes_back(true));
    assert_false(comes_back(false)); /* no memory is taken and nothing is restored */
}
