/* What a detector keeps when it moves over to another mesh, and what it refuses. */
#include "runtime/detector/detector.h"
#include "src/mesh/mesh_change.h"
#include "tests/support/calls.h"
#include "tests/support/moving_scene.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static cscd_mesh_change *make_change(cscd_context *context) {
    cscd_mesh_change *made = NULL;
    changing_scene_change(&moving.random, &moving.shape, &moving_change);
    expect_ok(
        cscd_mesh_change_create(context, moving_mesh_now(), moving_change.list, moving_change.count, &made));
    return made;
}

static void step_some(uint32_t count) {
    cscd_contacts found;
    for (uint32_t i = 0; i < count; i++) {
        moving_move_scene(0.02);
        expect_ok(step_packed(moving.detector, moving.x0, moving.x1, &found));
        moving_go_on();
    }
}

/* ---- what is kept ---------------------------------------------------------------------------------------- */

/* Regions, weights, points and states of each triangle before the change. */
typedef struct known_triangle {
    uint32_t region;
    double weight, offset[3];
    uint8_t state;
} known_triangle;

static known_triangle known[SCENE_TRIANGLES_MAX];

static known_triangle knowledge_of(const cscd_detector *d, uint32_t t) {
    known_triangle k = {d->interval.culling.triangle_regions[t],
                        d->interval.culling.triangle_weights[t],
                        {0.0},
                        d->known.starts.triangles[t]};
    memcpy(k.offset, d->interval.culling.detector_offsets[k.region], sizeof k.offset);
    return k;
}

static void check_knowledge(const cscd_mesh_change *made, size_t *kept, size_t *forgotten) {
    const cscd_detector *d = moving.detector;
    const cscd_mesh *mesh = cscd_mesh_change_mesh(made);
    const uint32_t *origins = cscd_mesh_change_to_old(made, CSCD_TRIANGLES, NULL);
    const uint32_t *components = cscd_mesh_change_to_old(made, CSCD_COMPONENTS, NULL);
    static uint32_t sizes[SCENE_TRIANGLES_MAX]; /* of regions; none is left without a triangle */
    memset(sizes, 0, sizeof sizes);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) sizes[d->interval.culling.triangle_regions[t]]++;
    for (uint32_t r = 0; r < d->interval.culling.region_count; r++) assert_true(sizes[r] > 0);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        known_triangle now = knowledge_of(d, t);
        uint32_t component = mesh->triangle_components[t];
        assert_true(now.region < d->interval.culling.region_count);
        if (components[component] == UINT32_MAX) {
            assert_int_equal(now.state, TRIANGLE_UNKNOWN);
            assert_true(now.weight == 1.0 / mesh->components[component].triangle_count);
            assert_true(now.offset[0] == 0.0 && now.offset[1] == 0.0 && now.offset[2] == 0.0);
            ++*forgotten;
        } else {
            const known_triangle *was = &known[origins[t]];
            assert_int_equal(now.state, was->state);
            assert_true(now.weight == was->weight);
            assert_memory_equal(now.offset, was->offset, sizeof now.offset);
            *kept += now.state == TRIANGLE_CLEAN;
        }
    }
}

/* The order of the triangles in the trees of untouched components stays. */
static void check_trees(const cscd_mesh_change *made, const bvh *old, size_t *kept) {
    const bvh *now = &moving.detector->rebuild.kept;
    const uint32_t *triangles = cscd_mesh_change_to_new(made, CSCD_TRIANGLES, NULL);
    const uint32_t *components = cscd_mesh_change_to_new(made, CSCD_COMPONENTS, NULL);
    const cscd_mesh *old_mesh = made->old_mesh;
    for (uint32_t slot = 0; now->mesh != NULL && slot < old->leaf_count * LANES; slot++) {
        uint32_t t = bvh_triangle(old, slot);
        if (t == UINT32_MAX || components[old_mesh->triangle_components[t]] == UINT32_MAX) continue;
        uint32_t to = now->slots[triangles[t]];
        assert_int_equal(bvh_triangle(now, to), triangles[t]);
        assert_int_equal(to % LANES, slot % LANES);
        if (slot % LANES > 0) assert_int_equal(now->slots[triangles[bvh_triangle(old, slot - 1)]], to - 1);
        ++*kept;
    }
}

TEST(keeps_what_is_untouched) {
    size_t kept = 0, forgotten = 0, in_trees = 0;
    for (uint64_t seed = 1000; seed < 1060; seed++) {
        cscd_context *context = context_of(0, NULL);
        moving_begin_scene(context, seed, true);
        step_some(3);
        for (int i = 0; i < 3; i++) {
            const cscd_detector *d = moving.detector;
            for (uint32_t t = 0; t < d->mesh->triangle_count; t++) known[t] = knowledge_of(d, t);
            cscd_detector *before = NULL;
            expect_ok(cscd_detector_clone(context, d, &before));
            cscd_mesh_change *made = make_change(context);
            expect_ok(cscd_detector_change_mesh(moving.detector, made));
            check_knowledge(made, &kept, &forgotten);
            if (before->space.bvh.mesh != NULL) check_trees(made, &before->space.bvh, &in_trees);
            cscd_detector_destroy(before);
            moving_take_change(made);
            step_some(1);
            assert_null(bvh_validate(&moving.detector->space.bvh, true));
        }
        moving_end_scene();
        cscd_context_destroy(context);
    }
    assert_true(kept > 1000 && forgotten > 1000 && in_trees > 1000);
}

/* Rest lengths of edges that were there stay; those of others are unknown. */
TEST(keeps_rest_lengths) {
    size_t kept = 0, unknown = 0;
    for (uint64_t seed = 2000; seed < 2020; seed++) {
        cscd_context *context = context_of(0, NULL);
        moving_begin_scene(context, seed, true);
        expect_ok(set_rest_packed(moving.detector, moving_joined.x0));
        uint32_t old_edges = cscd_mesh_edge_count(moving_mesh_now());
        double *before = malloc(old_edges * sizeof *before);
        memcpy(before, moving.detector->config.rest.squared_lengths, old_edges * sizeof *before);
        cscd_mesh_change *made = make_change(context);
        expect_ok(cscd_detector_change_mesh(moving.detector, made));
        uint32_t count;
        const uint32_t *origins = cscd_mesh_change_to_old(made, CSCD_EDGES, &count);
        for (uint32_t e = 0; e < count; e++) {
            double expected = origins[e] != UINT32_MAX ? before[origins[e]] : 0.0;
            assert_true(moving.detector->config.rest.squared_lengths[e] == expected);
            kept += expected > 0.0;
            unknown += expected == 0.0;
        }
        free(before);
        moving_take_change(made);
        moving_end_scene();
        cscd_context_destroy(context);
    }
    assert_true(kept > 1000 && unknown > 100);
}

/* What earlier calls have said is gone. */
TEST(forgets_what_was_said) {
    cscd_context *context = context_of(0, NULL);
    moving_begin_scene(context, 3000, true);
    step_some(2);
    moving_change_scene();
    cscd_counters counters = cscd_detector_counters(moving.detector), none = {0};
    assert_memory_equal(&counters, &none, sizeof none);
    assert_true(cscd_detector_timings(moving.detector).total_ms == 0.0);
    for (uint32_t c = 0; c < cscd_mesh_component_count(moving_mesh_now()); c++)
        assert_false(cscd_detector_guarantee(moving.detector, c).complete);
    moving_end_scene();
    cscd_context_destroy(context);
}

/* ---- what is refused ------------------------------------------------------------------------------------- */

/* Positions of new vertices have not been seen: they are checked, whatever bits they have. */
TEST(positions_that_are_no_numbers) {
    const uint32_t triangles[6] = {0, 1, 2, 2, 1, 3}, torn[6] = {0, 1, 2, 4, 1, 3};
    const uint32_t origins[5] = {0, 1, 2, 3, 2};
    const cscd_object_desc whole = cscd_object_of_triangles(4, 2, triangles);
    const cscd_object_desc parted = cscd_object_of_triangles(5, 2, torn);
    const cscd_object_change tear = {.object = 0, .desc = &parted, .vertex_origins = origins};
    const double x1[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    double x0[15];
    cscd_mesh_change *change = NULL;
    cscd_intersections crossing;
    cscd_contacts found;
    rig r = rig_of_objects(context_of(0, NULL), &whole, 1, NULL, NULL);
    expect_ok(check_packed(r.detector, x1, &crossing));
    expect_ok(cscd_mesh_change_create(r.context, r.mesh, &tear, 1, &change));
    expect_ok(cscd_detector_change_mesh(r.detector, change));
    memset(x0, 0xff, sizeof x0);
    assert_int_equal(step_packed(r.detector, x0, x1, &found), CSCD_INVALID_ARGUMENT);
    expect_ok(step_packed(r.detector, x1, x1, &found));
    cscd_mesh_change_destroy(change);
    rig_destroy(&r);
}

TEST(refused_changes) {
    cscd_context *context = context_of(0, NULL);
    moving_begin_scene(context, 4000, true);
    cscd_mesh *other = changing_scene_mesh(context, &moving.shape);
    cscd_mesh_change *made = NULL;
    expect_ok(cscd_mesh_change_create(context, other, NULL, 0, &made));
    expect_invalid(context, cscd_detector_change_mesh(moving.detector, made),
                   "another mesh than the detector's");
    assert_int_equal(cscd_detector_change_mesh(NULL, made), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_detector_change_mesh(moving.detector, NULL), CSCD_NULL_OBJECT);
    step_some(1);
    cscd_mesh_change_destroy(made);
    cscd_mesh_destroy(other);
    moving_end_scene();
    cscd_context_destroy(context);
}

static void check_line_refused(cscd_line_search *line) {
    static double positions[MOVING_VERTICES * 3];
    cscd_free_step step;
    cscd_proximities near;
    const cscd_mutable_view *view =
        CSCD_MUTABLE_DOUBLES(positions, cscd_mesh_vertex_count(moving_mesh_now()));
    cscd_context *context = cscd_mesh_context(moving_mesh_now());
    expect_invalid(context, cscd_line_search_max_step(line, 1.0, NULL, &step), "moved to another mesh");
    expect_invalid(context, cscd_line_search_positions(line, 0.5, view), "moved to another mesh");
    expect_invalid(context, cscd_line_search_find_near(line, 0.5, 0.0, CSCD_NEAR_PAIRS, &near),
                   "moved to another mesh");
    assert_int_equal(cscd_line_search_candidate_count(line), 0);
}

TEST(line_searches_begin_again) {
    static double reached[2][MOVING_VERTICES * 3];
    for (uint64_t seed = 5000; seed < 5030; seed++) {
        counting_allocator counter = counting_allocator_start();
        cscd_context *context = context_of(0, &counter);
        moving_begin_scene(context, seed, true);
        cscd_line_search *line = NULL, *fresh = NULL;
        expect_ok(cscd_line_search_create(moving.detector, &line));
        moving_move_scene(0.2);
        expect_ok(line_begin_packed(line, moving.x0, moving.x1, 0.1));
        moving_change_scene();
        check_line_refused(line);
        moving_move_scene(0.2);
        counter.fail_at = counter.calls;
        assert_int_equal(line_begin_packed(line, moving.x0, moving.x1, 0.1), CSCD_OUT_OF_MEMORY);
        counter.fail_at = SIZE_MAX;
        check_line_refused(line);
        expect_ok(line_begin_packed(line, moving.x0, moving.x1, 0.1));
        expect_ok(cscd_line_search_create(moving.detector, &fresh));
        expect_ok(line_begin_packed(fresh, moving.x0, moving.x1, 0.1));
        cscd_free_step a, b;
        cscd_status status = line_max_step_packed(line, 1.0, reached[0], &a);
        assert_int_equal(line_max_step_packed(fresh, 1.0, reached[1], &b), status);
        assert_true(status != CSCD_OK || a.fraction == b.fraction);
        cscd_line_search_destroy(fresh);
        cscd_line_search_destroy(line);
        moving_end_scene();
        cscd_context_destroy(context);
        assert_int_equal(counter.live, 0);
    }
}
