/* A detector that has moved over to another mesh finds what a new one finds there, and keeps what is untouched. */
#include "tests/support/calls.h"
#include "tests/support/moving_scene.h"
#include "tests/support/oracle.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The component of both features, UINT32_MAX if these are two. */
static uint32_t contact_component(const cscd_mesh *mesh, const cscd_contact *c) {
    uint32_t a = mesh->triangle_components[mesh->vertex_stars[mesh->vertex_star_offsets[c->vertices[0]]]];
    uint32_t b = mesh->triangle_components[mesh->vertex_stars[mesh->vertex_star_offsets[c->vertices[3]]]];
    return a == b ? a : UINT32_MAX;
}

/* Other contacts of a component than one of the first may be missing, if the detector says so. */
static void check_missing(const cscd_contacts *found, const cscd_contacts *all, const cscd_contact *missing) {
    const cscd_mesh *mesh = moving_mesh_now();
    uint32_t component = contact_component(mesh, missing);
    assert_true(moving.earliest && component != UINT32_MAX);
    assert_int_equal(cscd_detector_guarantee(moving.detector, component).reason, CSCD_REASON_EARLIEST);
    double first = 2.0, first_found = 2.0;
    for (size_t i = all->count; i-- > 0;) {
        const cscd_contact *c = &all->items[i];
        if (torn_model_waits(c->kind, c->a, c->b)) continue;
        if (contact_component(mesh, c) == component) first = all->items[i].toi;
    }
    for (size_t i = found->count; i-- > 0;) {
        if (contact_component(mesh, &found->items[i]) == component) first_found = found->items[i].toi;
    }
    assert_true(first == first_found);
}

static void compare_steps(cscd_detector *expected, size_t *contacts) {
    cscd_contacts a, b;
    size_t i = 0;
    expect_ok(step_packed(moving.detector, moving.x0, moving.x1, &a));
    expect_ok(step_packed(expected, moving.x0, moving.x1, &b));
    assert_int_equal(cscd_detector_waiting(moving.detector).features, torn_model_count());
    for (size_t j = 0; j < b.count; j++) {
        if (torn_model_waits(b.items[j].kind, b.items[j].a, b.items[j].b)) continue;
        if (i < a.count && memcmp(&a.items[i], &b.items[j], sizeof *a.items) == 0)
            i++;
        else
            check_missing(&a, &b, &b.items[j]);
    }
    assert_int_equal(i, a.count);
    *contacts += a.count;
}

static void compare_with_oracle(void) {
    oracle_list truth = {NULL, 0, 0};
    cscd_contacts found;
    memcpy(moving_joined.x0, moving.x0, moving_joined.vertex_count * sizeof(double[3]));
    memcpy(moving_joined.x1, moving.x1, moving_joined.vertex_count * sizeof(double[3]));
    oracle_find(&moving_joined, &truth);
    expect_ok(step_packed(moving.detector, moving.x0, moving.x1, &found));
    assert_int_equal(found.count, truth.count);
    for (size_t i = 0; i < found.count; i++) {
        assert_true(found.items[i].kind == truth.items[i].kind && found.items[i].a == truth.items[i].a &&
                    found.items[i].b == truth.items[i].b);
    }
    oracle_free(&truth);
}

static void compare_checks(cscd_detector *expected) {
    cscd_intersections a, b;
    expect_ok(check_packed(moving.detector, moving.x0, &a));
    expect_ok(check_packed(expected, moving.x0, &b));
    assert_int_equal(a.zero_area_triangles, b.zero_area_triangles);
    size_t i = 0;
    for (size_t j = 0; j < b.count; j++) {
        if (torn_model_waits(CSCD_CONTACT_TT, b.items[j].a, b.items[j].b)) continue;
        assert_true(i < a.count && memcmp(&a.items[i++], &b.items[j], sizeof *a.items) == 0);
    }
    assert_int_equal(i, a.count);
}

static void compare_max_steps(cscd_detector *expected) {
    static double reached[2][MOVING_VERTICES * 3];
    cscd_free_step a, b;
    cscd_status status = max_step_packed(expected, moving.x0, moving.x1, reached[1], &b);
    assert_int_equal(max_step_packed(moving.detector, moving.x0, moving.x1, reached[0], &a), status);
    if (status != CSCD_OK) return;
    assert_true(a.fraction == b.fraction && a.limited == b.limited);
    assert_memory_equal(reached[0], reached[1], moving_joined.vertex_count * sizeof(double[3]));
}

/* Where a motion starts, pairs that are apart are let go. */
static void settle_model(cscd_detector *expected) {
    cscd_contacts at_rest;
    cscd_intersections crossing;
    expect_ok(step_packed(expected, moving.x0, moving.x0, &at_rest));
    expect_ok(check_packed(expected, moving.x0, &crossing));
    torn_model_settle(&at_rest, &crossing);
}

/* Several changes in a row, some without a call between them; between others, several calls. */
TEST(equals_a_new_detector) {
    size_t contacts = 0, culled = 0, waited = 0;
    for (uint64_t seed = 0; seed < 170; seed++) {
        counting_allocator counter = counting_allocator_start();
        cscd_context *context = context_of(0, &counter);
        bool plain = seed % 3 == 0;
        moving_begin_scene(context, seed, plain);
        for (int round = 0; round < 5; round++) {
            uint32_t changes = seed % 7 == 0 && round == 0 ? 1 : 1 + stream_below(&moving.random, 2);
            for (uint32_t i = 0; round > 0 && i < changes; i++) moving_change_scene();
            cscd_mesh *mesh = changing_scene_mesh(context, &moving.shape);
            check_same_mesh(moving_mesh_now(), mesh);
            cscd_detector *expected = moving_new_detector(mesh, NULL);
            uint32_t calls = stream_below(&moving.random, 4);
            if (seed % 5 == 0) moving_replace_by_clone();
            for (uint32_t i = 0; i < calls; i++) {
                moving_move_scene(0.3);
                settle_model(expected);
                waited += torn_model_count();
                uint32_t what = stream_below(&moving.random, 6);
                if (what == 0) compare_checks(expected);
                if (what == 1 && torn_model_count() == 0) compare_max_steps(expected);
                compare_steps(expected, &contacts);
                culled += cscd_detector_counters(moving.detector).clean > 0;
                if (plain && !moving.earliest && what == 2 && torn_model_count() == 0 &&
                    moving.options.min_separation == 0.0) {
                    bool obstacles = moving_mesh_now()->obstacles != NULL;
                    if (!obstacles) compare_with_oracle();
                }
                moving_go_on();
            }
            cscd_detector_destroy(expected);
            cscd_mesh_destroy(mesh);
        }
        moving_end_scene();
        cscd_context_destroy(context);
        assert_int_equal(counter.live, 0);
    }
    assert_true(contacts > 10000 && culled > 50 && waited > 1000);
}
