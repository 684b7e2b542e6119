/* The detector with several threads, repeated steps, ignored pairs, and bad arguments. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene interval, other; /* large; one test at a time */

TEST(earlier_steps_leave_no_trace) {
    scene_make(SCENE_BOW_TIE, 1, &interval);
    rig r = rig_create(&interval, 1, NULL);
    cscd_contacts found = rig_step(&r, &interval);
    size_t count = found.count;
    cscd_contact *first = malloc((count + 1) * sizeof *first);
    assert_non_null(first);
    memcpy(first, found.items, count * sizeof *first);
    for (uint64_t seed = 2; seed < 6; seed++) {
        scene_make(SCENE_BOW_TIE, seed, &other);
        rig_step(&r, &other);
        cscd_intersections crossing;
        expect_ok(check_packed(r.detector, other.x1, &crossing));
    }
    found = rig_step(&r, &interval);
    assert_int_equal(found.count, count);
    assert_memory_equal(found.items, first, count * sizeof *first);
    free(first);
    rig_destroy(&r);
}

/* ---- ignored pairs --------------------------------------------------------------------------------- */

static bool in_triangle(const scene *s, uint32_t triangle, uint32_t vertex) {
    const uint32_t *t = s->triangles + (size_t)triangle * 3;
    return t[0] == vertex || t[1] == vertex || t[2] == vertex;
}

/* Returns whether a feature of the contact belongs to the triangle. */
static bool touches_triangle(const scene *s, const rig *r, const cscd_contact *c, uint32_t triangle) {
    if (c->kind == CSCD_CONTACT_VF) return c->b == triangle || in_triangle(s, triangle, c->a);
    uint32_t a[2], b[2];
    cscd_mesh_edge(r->mesh, c->a, a);
    cscd_mesh_edge(r->mesh, c->b, b);
    return (in_triangle(s, triangle, a[0]) && in_triangle(s, triangle, a[1])) ||
           (in_triangle(s, triangle, b[0]) && in_triangle(s, triangle, b[1]));
}

typedef struct chosen_triangle {
    const rig *rig; /* of a mesh with the same triangles */
    uint32_t triangle;
} chosen_triangle;

static bool ignore_all_of_one(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const chosen_triangle *chosen = user;
    const cscd_contact contact = {.kind = kind, .a = a, .b = b};
    assert_true(kind == CSCD_CONTACT_VF || (kind == CSCD_CONTACT_EE && a < b));
    return touches_triangle(&interval, chosen->rig, &contact, chosen->triangle);
}

TEST(ignored_pairs_are_left_out) {
    uint32_t tested = 0;
    size_t left_out = 0;
    for (uint64_t seed = 1; seed < 40; seed++) {
        scene_make(SCENE_FOLDED_SHEET, seed, &interval);
        rig plain = rig_create(&interval, 1, NULL);
        cscd_contacts all = rig_step(&plain, &interval);
        if (all.count < 10) {
            rig_destroy(&plain);
            continue;
        }
        tested++;
        uint32_t triangle = all.items[0].kind == CSCD_CONTACT_VF ? all.items[0].b : (uint32_t)seed % 7;
        cscd_detector_options options = cscd_detector_defaults();
        options.ignore = ignore_all_of_one;
        chosen_triangle chosen = {&plain, triangle};
        options.ignore_user = &chosen;
        rig picky = rig_create(&interval, 1, &options);
        cscd_contacts some = rig_step(&picky, &interval);
        size_t j = 0;
        for (size_t i = 0; i < all.count; i++) {
            if (touches_triangle(&interval, &plain, &all.items[i], triangle)) continue;
            assert_true(j < some.count);
            assert_memory_equal(&some.items[j++], &all.items[i], sizeof *all.items);
        }
        assert_int_equal(j, some.count);
        left_out += all.count - some.count;
        rig_destroy(&picky);
        rig_destroy(&plain);
    }
    print_message("  %u of 39 scenes, %zu contacts left out\n", tested, left_out);
    assert_true(tested >= 10 && left_out > 50);
}

/* ---- statuses -------------------------------------------------------------------------------------- */

TEST(bad_positions_are_named) {
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e300, 1e-300, 5e-324};
    scene_make(SCENE_SPIKE, 1, &interval);
    rig r = rig_create(&interval, 1, NULL);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        other = interval;
        other.x1[3 * 17 + 1] = bad[i];
        cscd_contacts untouched = {.count = 4711};
        cscd_intersections unchanged = {.count = 4711};
        assert_int_equal(step_packed(r.detector, other.x0, other.x1, &untouched), CSCD_INVALID_ARGUMENT);
        assert_int_equal(untouched.count, 4711);
        assert_non_null(strstr(cscd_context_detail(r.context), "x1: vertex 17 has y"));
        assert_int_equal(check_packed(r.detector, other.x1, &unchanged), CSCD_INVALID_ARGUMENT);
        assert_int_equal(unchanged.count, 4711);
    }
    rig_step(&r, &interval);
    rig_destroy(&r);
}

TEST(bad_arguments_are_refused) {
    scene_make(SCENE_SPIKE, 1, &interval);
    rig r = rig_create(&interval, 1, NULL);
    cscd_contacts found;
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    assert_int_equal(step_packed(NULL, interval.x0, interval.x1, &found), CSCD_NULL_OBJECT);
    assert_int_equal(step_packed(r.detector, NULL, interval.x1, &found), CSCD_INVALID_ARGUMENT);
    assert_int_equal(step_packed(r.detector, interval.x0, NULL, &found), CSCD_INVALID_ARGUMENT);
    assert_int_equal(step_packed(r.detector, interval.x0, interval.x1, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(detector_create_here(NULL, NULL, NULL, &detector), CSCD_NULL_OBJECT);
    assert_int_equal(detector_create_here(r.mesh, NULL, NULL, NULL), CSCD_INVALID_ARGUMENT);
    options.method = (cscd_method)99;
    assert_int_equal(detector_create_here(r.mesh, NULL, &options, &detector), CSCD_INVALID_ARGUMENT);
    options = (cscd_detector_options){0};
    expect_invalid(r.context, detector_create_here(r.mesh, NULL, &options, &detector),
                   "cscd_detector_defaults");
    assert_null(detector);
    rig_destroy(&r);
}

TEST(names_and_values_match) {
    cscd_method method = CSCD_METHOD_NONE;
    cscd_mode mode = CSCD_MODE_ALL;
    assert_true(cscd_from_name(CSCD_METHODS, "brute", (uint32_t *)&method));
    assert_int_equal(method, CSCD_METHOD_BRUTE);
    assert_string_equal(cscd_method_name(CSCD_METHOD_NONE), "none");
    assert_false(cscd_from_name(CSCD_METHODS, "warp", (uint32_t *)&method));
    assert_false(cscd_from_name(CSCD_METHODS, NULL, (uint32_t *)&method));
    assert_int_equal(method, CSCD_METHOD_BRUTE);
    assert_true(cscd_from_name(CSCD_MODES, "all", (uint32_t *)&mode));
    assert_false(cscd_from_name(CSCD_MODES, "some", (uint32_t *)&mode));
    assert_string_equal(cscd_version_string(), "2.0.0");
}
