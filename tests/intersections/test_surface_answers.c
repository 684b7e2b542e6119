/* Curves, patches, overlaps and depths through the public API: the same for any method and number of threads, without what
 * is left out, refused where they make no sense, without memory, and with none in a steady state. */
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/intersections/answer_lists.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static body_rig rig, other; /* large; one test at a time */

static void add_scene(body_rig *r) {
    static const double origin[3] = {0, 0, 0}, centre[3] = {0.9, 0.2, 0.1};
    body_rig_begin(r);
    body_rig_add_snake(r);
    body_rig_end_body(r);
    scene_add_sphere(&r->all, centre, 0.6, 9, 14);
    body_rig_end_body(r);
    scene_add_torus(&r->all, origin, 1.0, 0.35, 24, 12, true);
    body_rig_end_body(r);
}

TEST(methods_and_threads_agree) {
    const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_BRUTE};
    add_scene(&rig);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
    assert_true(rig.found.curves->count > 3 && rig.found.patches->count > 6 && rig.found.depths->count > 50);
    assert_true(rig.found.overlaps->count >= 3);
    for (uint32_t i = 0; i < 6; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        options.method = methods[i % 3];
        options.volume = i < 3 ? CSCD_VOLUME_BOX : CSCD_VOLUME_KDOP14;
        add_scene(&other);
        body_rig_create(&other, &options, 1 + i % 4);
        body_rig_find(&other);
        compare_answers(rig.mesh, &rig.found, &other.found);
    }
}

/* ---- what is left out ------------------------------------------------------------------------------------ */

static bool names_object(uint32_t object) {
    const cscd_intersections *f = &rig.found;
    for (size_t i = 0; i < f->curves->count; i++) {
        if (f->curves->items[i].objects[0] == object || f->curves->items[i].objects[1] == object) return true;
    }
    for (size_t i = 0; i < f->patches->winding_count; i++) {
        if (f->patches->windings[i].body == object) return true;
    }
    for (size_t i = 0; i < f->overlaps->count; i++) {
        if (f->overlaps->items[i].a == object || f->overlaps->items[i].b == object) return true;
    }
    for (size_t i = 0; i < f->depths->count; i++) {
        if (f->depths->items[i].body == object) return true;
    }
    return false;
}

TEST(masked_objects_bury_nothing) {
    cscd_object_rule rules[3] = {cscd_object_rule_default(), cscd_object_rule_default(),
                                 cscd_object_rule_default()};
    cscd_detector_options options = cscd_detector_defaults();
    rules[2].mask = 0;
    rules[2].self = false;
    options.rules = rules;
    options.rule_count = 3;
    add_scene(&rig);
    body_rig_create(&rig, &options, 2);
    body_rig_find(&rig);
    assert_true(names_object(0) && names_object(1) && !names_object(2));
}

/* Without one of its pairs a curve is open there, and the overlap has no volume. */
TEST(an_ignored_pair_opens_a_curve) {
    static const double low[3] = {0, 0, 0}, size[3] = {2, 2, 2}, second[3] = {1.25, 1.5, 1.125};
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    body_rig_box(&rig, second, size);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
    assert_int_equal(rig.found.curves->count, 1);
    assert_true(rig.found.curves->items[0].closed && rig.found.overlaps->items[0].volume > 0.0);
    const uint32_t ignored[2] = {rig.found.curves->pieces[0].a, rig.found.curves->pieces[0].b};
    expect_ok(cscd_detector_set_ignored(rig.detector, ignored, 1));
    body_rig_find(&rig);
    body_rig_find(&rig); /* the pair may have waited once */
    assert_int_equal(rig.found.curves->count, 1);
    assert_int_equal(rig.found.curves->items[0].start, CSCD_CURVE_END_LEFT_OUT);
    assert_int_equal(rig.found.curves->items[0].end, CSCD_CURVE_END_LEFT_OUT);
    assert_true(isnan(rig.found.overlaps->items[0].volume));
}

/* ---- calls ------------------------------------------------------------------------------------------------ */

TEST(the_list_of_all_pairs_is_needed) {
    add_scene(&rig);
    body_rig_create(&rig, NULL, 1);
    for (int i = 0; i < 4; i++) {
        cscd_intersection_options options = cscd_intersection_defaults();
        cscd_intersections found;
        *(i == 0   ? &options.curves
          : i == 1 ? &options.patches
          : i == 2 ? &options.overlaps
                   : &options.depths) = true;
        if (i % 2 == 0) options.answer = i == 0 ? CSCD_ANSWER_COUNT : CSCD_ANSWER_ANY;
        if (i == 1) options.kinds = cscd_intersection_set(CSCD_INTERSECTION_CROSSING);
        if (i == 3) options.stop_after = 5;
        expect_invalid(rig.context,
                       cscd_detector_find_intersections(
                           rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count), &options, &found),
                       "need the list of all pairs");
    }
}

/* The caller's function, which is asked while pairs are found, asks the detector. */
static bool ask_again(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    size_t *asked = user;
    cscd_intersections kept = rig.found;
    assert_true(kind == CSCD_CONTACT_TT && a < b);
    assert_int_equal(body_rig_try(&rig), CSCD_BUSY);
    assert_memory_equal(&kept, &rig.found, sizeof kept);
    (*asked)++;
    return false;
}

TEST(called_from_within) {
    size_t asked = 0;
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = ask_again;
    options.ignore_user = &asked;
    add_scene(&other);
    body_rig_create(&other, NULL, 1);
    body_rig_find(&other);
    add_scene(&rig);
    memset(&rig.found, 0, sizeof rig.found);
    body_rig_create(&rig, &options, 1);
    body_rig_find(&rig);
    assert_true(asked >= rig.found.count && asked > 0);
    compare_answers(rig.mesh, &rig.found, &other.found);
}

TEST(only_what_is_asked_for) {
    add_scene(&rig);
    body_rig_create(&rig, NULL, 1);
    for (int i = 0; i < 4; i++) {
        cscd_intersection_options options = cscd_intersection_defaults();
        options.curves = i == 1;
        options.patches = i == 2;
        options.depths = i == 3;
        expect_ok(cscd_detector_find_intersections(
            rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count), &options, &rig.found));
        assert_int_equal(rig.found.curves != NULL, i > 0);
        assert_int_equal(rig.found.patches != NULL, i >= 2);
        assert_int_equal(rig.found.depths != NULL, i >= 3);
        assert_true(rig.found.overlaps == NULL);
    }
}

/* Moves the ball forwards, and back again. */
static void sway_ball(int steps) {
    for (int i = 0; i < 2 * steps; i++) {
        for (uint32_t k = 0; k < rig.bodies[1].vertex_count * 3; k++)
            rig.all.x0[rig.bodies[1].first_vertex * 3 + k] += i < steps ? 0.01 : -0.01;
        body_rig_find(&rig);
    }
}

enum { STEADY_RUNS = 2 };

/* With several threads, which of them finds what differs from call to call. */
TEST(a_steady_state_allocates_nothing) {
    for (uint32_t run = 0; run < STEADY_RUNS; run++) {
        counting_allocator counter = counting_allocator_start();
        add_scene(&rig);
        rig.counter = &counter;
        body_rig_create(&rig, NULL, run == 0 ? 1 : 4);
        sway_ball(3);
        size_t calls = counter.calls;
        sway_ball(3);
        sway_ball(3);
        assert_int_equal(counter.calls, calls);
        body_rig_free(&rig);
    }
}

/* A new mesh and a second detector have answers of their own. */
TEST(clones_answer_alike) {
    cscd_detector *first, *second;
    add_scene(&rig);
    body_rig_create(&rig, NULL, 2);
    add_scene(&other);
    body_rig_create(&other, NULL, 1);
    body_rig_find(&rig);
    body_rig_find(&other);
    expect_ok(cscd_detector_clone(rig.context, rig.detector, &second));
    first = rig.detector;
    rig.detector = second;
    body_rig_find(&rig);
    compare_answers(rig.mesh, &rig.found, &other.found);
    cscd_detector_destroy(first);
    body_rig_find(&rig);
    compare_answers(rig.mesh, &rig.found, &other.found);
}

/* A box in a ball has a triangle, the first one, with two corners that a seam unites at one place: nothing is to the sides of
 * that triangle, and the box is buried all the same. Then all corners of the box are one point. */
TEST(a_seam_within_a_triangle) {
    static const double origin[3] = {0, 0, 0}, low[3] = {-0.25, -0.25, -0.25}, size[3] = {0.5, 0.5, 0.5};
    uint32_t seams[7][2];
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    scene_add_sphere(&rig.all, origin, 1.0, 9, 14);
    body_rig_end_body(&rig);
    const uint32_t *corners = rig.all.triangles;
    seams[0][0] = corners[0];
    seams[0][1] = corners[1];
    memcpy(&rig.all.x0[corners[1] * 3], &rig.all.x0[corners[0] * 3], sizeof(double[3]));
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = &seams[0][0];
    options.seam_count = 1;
    options.seam_reach = (double)INFINITY;
    body_rig_create(&rig, &options, 1);
    body_rig_find(&rig);
    assert_int_equal(rig.found.patches->count, 2);
    const cscd_patch *box = &rig.found.patches->items[0];
    assert_true(box->triangle > 0 && box->winding_count == 1);
    assert_int_equal(rig.found.patches->windings[box->first_winding].number, 1);
    assert_int_equal(rig.found.depths->vertex_count, 8);
    for (uint32_t v = 1; v < 8; v++) {
        seams[v - 1][0] = 0;
        seams[v - 1][1] = v;
        memcpy(&rig.all.x0[v * 3], &rig.all.x0[0], sizeof(double[3]));
    }
    expect_ok(cscd_detector_set_seams(rig.detector, &seams[0][0], 7));
    body_rig_find(&rig);
    assert_int_equal(rig.found.patches->items[0].winding_count, 0);
}

/* A body comes to the mesh: nothing of the old answers fits. */
TEST(a_larger_mesh_has_its_own_answers) {
    cscd_mesh_change *change;
    cscd_object_desc desc;
    add_scene(&other);
    body_rig_create(&other, NULL, 1);
    body_rig_find(&other);
    add_scene(&rig);
    rig.body_count = 2;
    body_rig_create(&rig, NULL, 1);
    rig.all.vertex_count -= rig.bodies[2].vertex_count;
    body_rig_find(&rig);
    desc = cscd_object_of_triangles(rig.bodies[2].vertex_count, rig.bodies[2].triangle_count,
                                    rig.bodies[2].triangles);
    const cscd_object_change added = {.object = UINT32_MAX, .desc = &desc};
    expect_ok(cscd_mesh_change_create(rig.context, rig.mesh, &added, 1, &change));
    expect_ok(cscd_detector_change_mesh(rig.detector, change));
    cscd_mesh_change_destroy(change);
    rig.all.vertex_count += rig.bodies[2].vertex_count;
    body_rig_find(&rig);
    compare_answers(rig.mesh, &rig.found, &other.found);
}

TEST(names_of_ends) {
    assert_string_equal(cscd_name(CSCD_CURVE_ENDS, CSCD_CURVE_END_NONE), "none");
    assert_string_equal(cscd_name(CSCD_CURVE_ENDS, CSCD_CURVE_END_LEFT_OUT), "left out");
    assert_string_equal(cscd_name(CSCD_CURVE_ENDS, (cscd_curve_end)77), "unknown");
}

AROUND_EACH(NULL, body_rigs_free)
