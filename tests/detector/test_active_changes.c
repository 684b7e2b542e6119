/* Active vertices while trees are built again, meshes change, detectors are cloned, and memory runs out. */
#include "cscd/cscd.h"
#include "tests/support/active_twins.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/moving_scene.h"
#include "tests/support/packed.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static active_twins twins; /* large, as the others; one test at a time */
static scene s;

static void set_vertices(cscd_detector *d, const uint32_t *vertices, size_t count) {
    assert_int_equal(cscd_detector_set_active(d, vertices, count), CSCD_OK);
}

/* The first of two spheres flies into the other one. Returns how many vertices it has. */
static uint32_t make_flying_sphere(uint32_t *vertices) {
    scene_clear(&s);
    for (int i = 0; i < 2; i++) scene_add_sphere(&s, (double[3]){2.5 * i, 0, 0}, 1.0, 8, 10);
    uint32_t count = s.vertex_count / 2;
    for (uint32_t v = 0; v < count; v++) {
        vertices[v] = v;
        s.x1[v * 3] += 1.0;
    }
    return count;
}

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
    const uint32_t *origins = cscd_mesh_change_vertex_origins(moving.last, &count);
    memcpy(before, twins.active, sizeof before);
    for (uint32_t v = 0; v < count; v++) twins.active[v] = origins[v] == UINT32_MAX || before[origins[v]];
}

static void change_both(size_t *told) {
    cscd_detector *theirs = twins.theirs;
    moving_change_scene();
    map_set();
    assert_int_equal(cscd_detector_change_mesh(theirs, moving.last), CSCD_OK);
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
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context = NULL;
    size_t told = 0;
    memset(&twins, 0, sizeof twins);
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    for (uint64_t seed = 0; seed < 24; seed++) run_changes(context, seed, &told);
    cscd_context_destroy(context);
    print_message("changes: %zu contacts, %zu near, %zu left out, %zu waiting, told %zu times\n",
                  twins.contacts, twins.near, twins.left_out, twins.waiting, told);
    assert_true(twins.contacts > 300 && twins.near > 300 && twins.left_out > 300 && told > 3);
}

/* ---- memory -------------------------------------------------------------------------------------------- */

typedef struct counted_rig {
    counting_allocator counter;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} counted_rig;

static void counted_begin(counted_rig *r) {
    cscd_context_options options = cscd_context_defaults();
    const cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    r->counter = counting_allocator_start();
    options.allocator = counting_allocator_interface(&r->counter);
    options.thread_count = 1;
    assert_int_equal(cscd_context_create(&options, &r->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r->context, &desc, 1, &r->mesh), CSCD_OK);
    assert_int_equal(detector_create_here(r->mesh, NULL, NULL, &r->detector), CSCD_OK);
}

static void counted_end(counted_rig *r) {
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    assert_int_equal(r->counter.live, 0);
}

/* The set is given before there are trees, or after. */
TEST(every_allocation_may_fail) {
    static uint32_t vertices[SCENE_VERTICES_MAX];
    size_t failures = 0;
    uint32_t count = make_flying_sphere(vertices);
    static scene whole;
    memcpy(&whole, &s, sizeof whole);
    for (uint32_t v = count; v < s.vertex_count; v++) whole.x1[v * 3] -= 0.1;
    for (int trees = 0; trees < 2; trees++) {
        bool failed = true;
        for (size_t n = 0; failed; n++) {
            counted_rig r;
            cscd_contacts found;
            counted_begin(&r);
            if (trees == 1) assert_int_equal(step_packed(r.detector, whole.x0, whole.x1, &found), CSCD_OK);
            r.counter.fail_at = r.counter.calls + n;
            cscd_status status = cscd_detector_set_active(r.detector, vertices, count);
            r.counter.fail_at = SIZE_MAX;
            failed = status == CSCD_OUT_OF_MEMORY;
            failures += failed;
            if (failed) /* all are active as before */
                assert_int_equal(step_packed(r.detector, whole.x0, whole.x1, &found), CSCD_OK);
            set_vertices(r.detector, vertices, count);
            assert_int_equal(step_packed(r.detector, whole.x0, whole.x1, &found), CSCD_INVALID_ARGUMENT);
            assert_int_equal(step_packed(r.detector, s.x0, s.x1, &found), CSCD_OK);
            size_t calls = r.counter.calls, contacts = found.count;
            set_vertices(r.detector, vertices, count - 1); /* takes no memory any more */
            set_vertices(r.detector, vertices, count);
            assert_int_equal(step_packed(r.detector, s.x0, s.x1, &found), CSCD_OK);
            assert_int_equal(r.counter.calls, calls);
            assert_int_equal(found.count, contacts);
            counted_end(&r);
        }
    }
    assert_true(failures > 4);
}

/* One of two objects goes; the change and the trees that follow it may fail anywhere. */
TEST(changes_may_fail) {
    size_t failures = 0;
    bool failed = true;
    cscd_contacts found;
    scene_make(SCENE_TWO_SPHERES, 3, &s);
    for (size_t n = 0; failed; n++) {
        counted_rig r;
        cscd_mesh_change *change = NULL;
        const uint32_t vertex = 1;
        const cscd_object_desc points = cscd_object_of_points(1);
        const cscd_object_change added = {.object = UINT32_MAX, .desc = &points};
        static double x0[SCENE_VERTICES_MAX * 3 + 3], x1[SCENE_VERTICES_MAX * 3 + 3];
        counted_begin(&r);
        assert_int_equal(step_packed(r.detector, s.x0, s.x0, &found), CSCD_OK);
        set_vertices(r.detector, &vertex, 1);
        assert_int_equal(cscd_mesh_change_create(r.context, r.mesh, &added, 1, &change), CSCD_OK);
        r.counter.fail_at = r.counter.calls + n;
        cscd_status status = cscd_detector_change_mesh(r.detector, change);
        r.counter.fail_at = SIZE_MAX;
        failed = status != CSCD_OK;
        if (failed) assert_int_equal(status, CSCD_OUT_OF_MEMORY);
        failures += failed;
        memcpy(x0, s.x0, sizeof s.x0);
        memcpy(x1, s.x0, sizeof s.x0);
        memset(x0 + s.vertex_count * 3, 0, sizeof(double[3]));
        memset(x1 + s.vertex_count * 3, 0, sizeof(double[3]));
        x1[3] += 0.1;
        if (!failed) x1[s.vertex_count * 3] = 0.5; /* new, so it may move */
        r.counter.fail_at = r.counter.calls + n;
        status = step_packed(r.detector, x0, x1, &found);
        r.counter.fail_at = SIZE_MAX;
        if (status != CSCD_OK) assert_int_equal(status, CSCD_OUT_OF_MEMORY);
        assert_int_equal(step_packed(r.detector, x0, x1, &found), CSCD_OK);
        x1[6] += 0.1;
        assert_int_equal(step_packed(r.detector, x0, x1, &found), CSCD_INVALID_ARGUMENT);
        cscd_mesh_change_destroy(change);
        counted_end(&r);
    }
    assert_true(failures > 10);
}
