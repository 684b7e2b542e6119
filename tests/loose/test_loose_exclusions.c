/* Contacts of loose features that are left out: by callback, and by seams. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/loose/loose_scene.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static loose_scene scene;

static const loose_recipe everything = {
    .triangles = true, .wires = true, .points = true, .half_spaces = true, .motion = 0.5};

typedef struct asked {
    const cscd_contacts *expected;
    size_t calls, unknown;
} asked;

/* Is asked about every contact, by its kind and features, and leaves out the even ones. */
static bool ignore_even(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    asked *q = user;
    bool known = false;
    for (size_t i = 0; i < q->expected->count; i++) {
        const cscd_contact *c = &q->expected->items[i];
        known |= c->kind == kind && c->a == a && c->b == b;
    }
    q->calls++;
    q->unknown += !known;
    return (a + b) % 2 == 0;
}

TEST(ignored_by_callback) {
    for (uint64_t seed = 0; seed < 6; seed++) {
        random_stream random = stream_start(200 + seed);
        loose_recipe recipe = everything;
        recipe.min_separation = seed % 2 == 0 ? 0.1 : 0.0;
        loose_scene_make(&scene, &recipe, &random, 2, CSCD_SIMD_AUTO);
        cscd_detector_options options = loose_scene_options(&scene);
        cscd_detector *whole = loose_scene_detector(&scene, &options), *partial = NULL;
        cscd_contacts all, some;
        asked q = {&all, 0, 0};
        options.ignore = ignore_even;
        options.ignore_user = &q;
        partial = loose_scene_detector(&scene, &options);
        assert_int_equal(step_packed(whole, scene.x0, scene.x1, &all), CSCD_OK);
        assert_int_equal(step_packed(partial, scene.x0, scene.x1, &some), CSCD_OK);
        assert_true(q.calls == all.count && q.unknown == 0);
        size_t at = 0;
        for (size_t i = 0; i < all.count; i++) {
            if ((all.items[i].a + all.items[i].b) % 2 == 0) continue;
            assert_true(at < some.count);
            assert_memory_equal(&some.items[at++], &all.items[i], sizeof some.items[0]);
        }
        assert_int_equal(at, some.count);
        cscd_detector_destroy(whole);
        cscd_detector_destroy(partial);
        loose_scene_free(&scene);
    }
}

/* Vertices of a seam count as one: pairs that have two of them are neighbours. */
static bool in_seam(const cscd_contact *c, const uint32_t seams[][2], size_t count) {
    int first = c->kind == CSCD_CONTACT_EE || c->kind == CSCD_CONTACT_EV ? 2 : 1;
    for (size_t s = 0; s < count; s++) {
        for (int i = 0; i < first; i++) {
            for (int k = first; k < 4; k++) {
                uint32_t a = c->vertices[i], b = c->vertices[k];
                if ((a == seams[s][0] && b == seams[s][1]) || (a == seams[s][1] && b == seams[s][0]))
                    return true;
            }
        }
    }
    return false;
}

TEST(seams_of_all_kinds) {
    size_t left_out[CSCD_CONTACT_VH + 1] = {0};
    for (uint64_t seed = 0; seed < 10; seed++) {
        random_stream random = stream_start(300 + seed);
        loose_recipe recipe = everything;
        recipe.min_separation = 0.6;
        loose_scene_make(&scene, &recipe, &random, 1, CSCD_SIMD_AUTO);
        uint32_t seams[8][2];
        for (uint32_t i = 0; i < 8; i++) { /* disjoint pairs, so that no chain unites more */
            seams[i][0] = i;
            seams[i][1] = scene.vertex_count - 1 - (i + 1) % 8 - stream_below(&random, 3) * 8;
        }
        cscd_detector_options options = loose_scene_options(&scene);
        cscd_detector *whole = loose_scene_detector(&scene, &options);
        options.seams = seams[0];
        options.seam_count = 8;
        options.seam_reach = INFINITY;
        cscd_detector *sewn = loose_scene_detector(&scene, &options);
        cscd_contacts all, some;
        assert_int_equal(step_packed(whole, scene.x0, scene.x1, &all), CSCD_OK);
        assert_int_equal(step_packed(sewn, scene.x0, scene.x1, &some), CSCD_OK);
        size_t at = 0;
        for (size_t i = 0; i < all.count; i++) {
            bool out = in_seam(&all.items[i], (const uint32_t(*)[2])seams, 8);
            left_out[all.items[i].kind] += out;
            if (out) continue;
            assert_true(at < some.count);
            assert_memory_equal(&some.items[at++], &all.items[i], sizeof some.items[0]);
        }
        assert_int_equal(at, some.count);
        cscd_detector_destroy(whole);
        cscd_detector_destroy(sewn);
        loose_scene_free(&scene);
    }
    print_message("  left out: %zu vf, %zu ee, %zu vv, %zu ev, %zu vh\n", left_out[CSCD_CONTACT_VF],
                  left_out[CSCD_CONTACT_EE], left_out[CSCD_CONTACT_VV], left_out[CSCD_CONTACT_EV],
                  left_out[CSCD_CONTACT_VH]);
    assert_true(left_out[CSCD_CONTACT_VF] > 0 && left_out[CSCD_CONTACT_EE] > 0 &&
                left_out[CSCD_CONTACT_VH] > 0 && left_out[CSCD_CONTACT_EV] + left_out[CSCD_CONTACT_VV] > 0);
}

/* Without a reach, a seam may be as long as the longest wire at its ends. */
TEST(reach_of_seams) {
    static const uint32_t wires[4] = {0, 1, 1, 2}, seam[2] = {2, 3};
    const double near[12] = {0, 0, 0, 1, 0, 0, 3, 0, 0, 3, 1.9, 0},
                 far[12] = {0, 0, 0, 1, 0, 0, 3, 0, 0, 3, 2.1, 0};
    const cscd_object_desc descs[2] = {cscd_object_of_wires(3, 2, wires), cscd_object_of_points(1)};
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, descs, 2, &mesh), CSCD_OK);
    for (int i = 0; i < 2; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        cscd_detector *detector = NULL;
        cscd_contacts found;
        const double *x = i == 0 ? near : far;
        options.seams = seam;
        options.seam_count = 1;
        options.min_separation = 5.0;
        assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_OK);
        assert_int_equal(step_packed(detector, x, x, &found), i == 0 ? CSCD_OK : CSCD_INVALID_ARGUMENT);
        if (i == 0)
            assert_true(found.count == 1 && found.items[0].kind == CSCD_CONTACT_EV && found.items[0].a == 0);
        cscd_detector_destroy(detector);
    }
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* On a curve of which no two pieces are near each other; half-spaces lie far below it. */
static void spread_vertex(uint32_t v, double *out) {
    const cscd_object_desc *object = &scene.objects[cscd_mesh_vertex_object(scene.mesh, v)];
    const double at[3] = {1e3 * v, 10.0 * v * v, 0.1 * v * v * v};
    for (int k = 0; k < 3; k++)
        out[k] = object->kind == CSCD_OBJECT_HALF_SPACE ? -1e8 * object->normal[k] : at[k];
}

/* What an opened seam uncovers waits until it has been apart once, whatever its kind. */
TEST(opened_seams) {
    static cscd_contact kept[20000];
    size_t waited[CSCD_CONTACT_VH + 1] = {0};
    for (uint64_t seed = 0; seed < 32; seed++) {
        random_stream random = stream_start(500 + seed);
        loose_recipe recipe = everything;
        double far[LOOSE_VERTICES_MAX * 3];
        recipe.min_separation = 0.6;
        loose_scene_make(&scene, &recipe, &random, 2, CSCD_SIMD_AUTO);
        uint32_t seams[8][2];
        for (uint32_t i = 0; i < 8; i++) {
            seams[i][0] = i;
            seams[i][1] = scene.vertex_count - 1 - (i + 1) % 8 - stream_below(&random, 3) * 8;
        }
        cscd_detector_options options = loose_scene_options(&scene);
        options.method = seed % 4 == 3 ? CSCD_METHOD_BRUTE : CSCD_METHOD_NONE;
        cscd_detector *whole = loose_scene_detector(&scene, &options), *sewn = NULL;
        options.seams = seams[0];
        options.seam_count = 8;
        options.seam_reach = INFINITY;
        sewn = loose_scene_detector(&scene, &options);
        cscd_contacts all, some;
        for (uint32_t v = 0; v < scene.vertex_count; v++) spread_vertex(v, far + (size_t)v * 3);
        assert_int_equal(step_packed(sewn, scene.x0, scene.x0, &some), CSCD_OK);
        size_t count = some.count;
        memcpy(kept, some.items, count * sizeof *kept);
        assert_int_equal(cscd_detector_set_seams(sewn, NULL, 0), CSCD_OK);
        assert_int_equal(step_packed(whole, scene.x0, scene.x0, &all), CSCD_OK);
        for (int again = 0; again < 2; again++) {
            assert_int_equal(step_packed(sewn, scene.x0, scene.x0, &some), CSCD_OK);
            assert_true(some.count == count && cscd_detector_waiting(sewn).features == all.count - count);
            assert_memory_equal(some.items, kept, count * sizeof *kept);
        }
        for (size_t i = 0; i < all.count; i++)
            waited[all.items[i].kind] += in_seam(&all.items[i], (const uint32_t(*)[2])seams, 8);
        assert_int_equal(step_packed(sewn, far, far, &some), CSCD_OK);
        assert_int_equal(step_packed(sewn, scene.x0, scene.x0, &some), CSCD_OK);
        assert_int_equal(some.count, all.count);
        assert_memory_equal(some.items, all.items, all.count * sizeof *all.items);
        cscd_detector_destroy(whole);
        cscd_detector_destroy(sewn);
        loose_scene_free(&scene);
    }
    for (int k = 0; k <= CSCD_CONTACT_VH; k++) assert_true(k == CSCD_CONTACT_TT || waited[k] > 0);
}
