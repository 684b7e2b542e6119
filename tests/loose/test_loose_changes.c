/* Loose objects while a mesh changes under a detector, and in clones: what is found is what a new detector finds. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/loose/loose_scene.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static loose_scene scene;

static const loose_recipe everything = {
    .triangles = true, .wires = true, .points = true, .half_spaces = true, .motion = 0.5, .thickness = true};

static void expect_same(const cscd_contacts *a, const cscd_contacts *b) {
    assert_int_equal(a->count, b->count);
    if (a->count > 0) assert_memory_equal(a->items, b->items, a->count * sizeof *a->items);
}

TEST(clones_find_the_same) {
    size_t contacts = 0;
    for (uint64_t seed = 0; seed < 8; seed++) {
        random_stream random = stream_start(seed);
        loose_recipe recipe = everything;
        recipe.triangles = seed % 3 != 0;
        loose_scene_make(&scene, &recipe, &random, 1, CSCD_SIMD_AUTO);
        cscd_detector_options options = loose_scene_options(&scene);
        cscd_detector *detector = NULL, *copy = NULL;
        cscd_contacts found, again;
        expect_ok(detector_create_here(scene.mesh, NULL, &options, &detector));
        if (seed % 2 == 0) expect_ok(step_packed(detector, scene.x0, scene.x1, &found));
        expect_ok(cscd_detector_clone(scene.context, detector, &copy));
        expect_ok(step_packed(detector, scene.x0, scene.x1, &found));
        expect_ok(step_packed(copy, scene.x0, scene.x1, &again));
        contacts += found.count;
        expect_same(&found, &again);
        cscd_detector_destroy(detector);
        cscd_detector_destroy(copy);
        loose_scene_free(&scene);
    }
    assert_true(contacts > 200);
}

/* ---- changes ------------------------------------------------------------------------------------------------ */

/* A scene to which a sphere has come and in which one object is missing. */
typedef struct changed_scene {
    cscd_mesh_change *change;
    double x0[LOOSE_VERTICES_MAX * 3], x1[LOOSE_VERTICES_MAX * 3];
} changed_scene;

static void map_positions(const cscd_mesh_change *change, const double *old, double *out) {
    uint32_t count;
    const uint32_t *origins = cscd_mesh_change_to_old(change, CSCD_VERTICES, &count);
    for (uint32_t v = 0; v < count; v++) {
        for (size_t k = 0; k < 3; k++)
            out[v * 3 + k] = origins[v] != UINT32_MAX ? old[origins[v] * 3 + k] : 0.1 * (double)(v % 7);
    }
}

static void change_scene(uint32_t removed, changed_scene *out) {
    const cscd_object_desc points = cscd_object_of_points(3);
    const cscd_object_change changes[2] = {{.object = removed}, {.object = UINT32_MAX, .desc = &points}};
    expect_ok(cscd_mesh_change_create(scene.context, scene.mesh, changes, 2, &out->change));
    map_positions(out->change, scene.x0, out->x0);
    map_positions(out->change, scene.x1, out->x1);
}

static cscd_detector *new_detector(const cscd_mesh *mesh, uint32_t removed) {
    cscd_object_rule rules[LOOSE_OBJECTS_MAX + 1];
    cscd_detector_options options = loose_scene_options(&scene);
    cscd_detector *detector = NULL;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene.object_count; i++) {
        if (i != removed) rules[count++] = scene.rules[i];
    }
    rules[count++] = cscd_object_rule_default();
    options.rules = rules;
    options.rule_count = count;
    expect_ok(detector_create_here(mesh, NULL, &options, &detector));
    return detector;
}

TEST(changed_meshes) {
    size_t contacts = 0;
    for (uint32_t removed = 0; removed < 8; removed++) {
        random_stream random = stream_start(100 + removed);
        loose_scene_make(&scene, &everything, &random, 2, CSCD_SIMD_AUTO);
        assert_int_equal(scene.object_count, 8);
        cscd_detector_options options = loose_scene_options(&scene);
        cscd_detector *detector = NULL, *fresh = NULL;
        changed_scene changed;
        cscd_contacts found, expected;
        expect_ok(detector_create_here(scene.mesh, NULL, &options, &detector));
        expect_ok(step_packed(detector, scene.x0, scene.x1, &found));
        change_scene(removed, &changed);
        expect_ok(cscd_detector_change_mesh(detector, changed.change));
        fresh = new_detector(cscd_detector_mesh(detector), removed);
        expect_ok(step_packed(detector, changed.x0, changed.x1, &found));
        expect_ok(step_packed(fresh, changed.x0, changed.x1, &expected));
        expect_same(&found, &expected);
        contacts += found.count;
        cscd_detector_destroy(detector);
        cscd_detector_destroy(fresh);
        cscd_mesh_change_destroy(changed.change);
        loose_scene_free(&scene);
    }
    assert_true(contacts > 200);
}

/* ---- tears ---------------------------------------------------------------------------------------------------- */

/* A rope is cut at vertex 1, and particle 0 becomes two: what was one vertex waits until it has been apart. */
TEST(cut_rope) {
    static const uint32_t rope[4] = {0, 1, 1, 2}, cut[4] = {0, 1, 3, 2}, origins[4] = {0, 1, 2, 1},
                          twins[2] = {0, 0};
    const double x[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 0, 0, 0, 5, 0, 0, 5, 0};
    double parted[18], old[12];
    cscd_object_desc before[2] = {cscd_object_of_wires(3, 2, rope), cscd_object_of_points(1)};
    cscd_object_desc after[2] = {cscd_object_of_wires(4, 2, cut), cscd_object_of_points(2)};
    const cscd_object_change changes[2] = {{.object = 0, .desc = &after[0], .vertex_origins = origins},
                                           {.object = 1, .desc = &after[1], .vertex_origins = twins}};
    cscd_mesh *mesh = NULL;
    cscd_mesh_change *change = NULL;
    cscd_detector *detector = NULL;
    cscd_contacts found;
    cscd_free_step step;
    assert_int_equal(cscd_context_create(NULL, &scene.context), CSCD_OK);
    expect_ok(cscd_mesh_create(scene.context, before, 2, &mesh));
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.1;
    expect_ok(detector_create_here(mesh, NULL, &options, &detector));
    memcpy(old, x, 9 * sizeof *x);
    memcpy(old + 9, x + 12, 3 * sizeof *x);
    expect_ok(step_packed(detector, old, old, &found));
    assert_int_equal(found.count, 0);
    expect_ok(cscd_mesh_change_create(scene.context, mesh, changes, 2, &change));
    expect_ok(cscd_detector_change_mesh(detector, change));
    expect_ok(step_packed(detector, x, x, &found));
    assert_true(found.count == 0 && cscd_detector_waiting(detector).features == 2);
    memcpy(parted, x, sizeof parted);
    parted[9] = 1.5;  /* the second half of the rope begins farther on */
    parted[16] = 5.5; /* and the twin is away */
    expect_ok(max_step_packed(detector, x, parted, parted, &step));
    assert_true(step.fraction == 1.0 && cscd_detector_waiting(detector).features == 2);
    expect_ok(step_packed(detector, parted, x, &found));
    assert_true(found.count == 2 && cscd_detector_waiting(detector).features == 0);
    assert_true(found.items[0].kind == CSCD_CONTACT_EE || found.items[1].kind == CSCD_CONTACT_EE);
    assert_true(found.items[0].kind == CSCD_CONTACT_VV || found.items[1].kind == CSCD_CONTACT_VV);
    cscd_detector_destroy(detector);
    cscd_mesh_change_destroy(change);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(scene.context);
}

/* A rope, a particle and a half-space are sewn to a vertex of a cloth; cloth and rope tear there. What the second
 * vertices were sewn to waits, each kind of pair, until it has been apart. */
TEST(tear_where_all_is_sewn) {
    static const uint32_t whole[6] = {0, 1, 2, 2, 1, 3}, torn[6] = {0, 1, 2, 4, 1, 3},
                          origins[5] = {0, 1, 2, 3, 2};
    static const uint32_t rope[4] = {0, 1, 0, 2}, cut[4] = {0, 1, 3, 2}, rope_origins[4] = {0, 1, 2, 0};
    static const uint32_t seams[6] = {2, 4, 2, 7, 2, 8}, seams_now[6] = {2, 5, 2, 9, 2, 10};
    static const double up[3] = {0, 0, 1};
    const double x[] = {0, 0, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1, 0, 1, 0, -1, 2, 1, -1, 0, 2, 0, 1, 0, 0, 1, 0};
    double now[33], parted[33];
    cscd_object_desc descs[4] = {cscd_object_of_triangles(4, 2, whole), cscd_object_of_wires(3, 2, rope),
                                 cscd_object_of_points(1), cscd_object_half_space(up)};
    cscd_object_desc after[2] = {cscd_object_of_triangles(5, 2, torn), cscd_object_of_wires(4, 2, cut)};
    const cscd_object_change tears[2] = {{.object = 0, .desc = &after[0], .vertex_origins = origins},
                                         {.object = 1, .desc = &after[1], .vertex_origins = rope_origins}};
    cscd_mesh *mesh = NULL;
    cscd_mesh_change *change = NULL;
    cscd_detector *detector = NULL, *fresh = NULL;
    cscd_contacts found, expected;
    memcpy(now, x, 12 * sizeof *x);
    memcpy(now + 12, x + 6, 3 * sizeof *x);
    memcpy(now + 15, x + 12, 9 * sizeof *x);
    memcpy(now + 24, x + 12, 3 * sizeof *x);
    memcpy(now + 27, x + 21, 6 * sizeof *x);
    memcpy(parted, now, sizeof now);
    for (int k = 0; k < 3; k++) parted[12 + k] += 0.4;
    for (int k = 0; k < 3; k++) parted[24 + k] += 0.8;
    assert_int_equal(cscd_context_create(NULL, &scene.context), CSCD_OK);
    expect_ok(cscd_mesh_create(scene.context, descs, 4, &mesh));
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.1;
    options.seams = seams;
    options.seam_count = 3;
    expect_ok(detector_create_here(mesh, NULL, &options, &detector));
    expect_ok(step_packed(detector, x, x, &found));
    assert_int_equal(found.count, 0);
    expect_ok(cscd_mesh_change_create(scene.context, mesh, tears, 2, &change));
    expect_ok(cscd_detector_change_mesh(detector, change));
    options.seams = seams_now;
    expect_ok(detector_create_here(cscd_mesh_change_mesh(change), NULL, &options, &fresh));
    expect_ok(step_packed(fresh, now, now, &expected));
    expect_ok(step_packed(detector, now, now, &found));
    assert_int_equal(found.count, 0);
    assert_int_equal(cscd_detector_waiting(detector).features, expected.count);
    uint32_t kinds = 0;
    for (size_t i = 0; i < expected.count; i++) kinds |= 1u << expected.items[i].kind;
    assert_int_equal(kinds, 1u << CSCD_CONTACT_VF | 1u << CSCD_CONTACT_EE | 1u << CSCD_CONTACT_EV |
                                1u << CSCD_CONTACT_VH);
    expect_ok(step_packed(detector, parted, now, &found));
    expect_ok(step_packed(fresh, parted, now, &expected));
    assert_int_equal(cscd_detector_waiting(detector).features, 0);
    expect_same(&found, &expected);
    cscd_detector_destroy(fresh);
    cscd_detector_destroy(detector);
    cscd_mesh_change_destroy(change);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(scene.context);
}

/* A cloth loses the triangle, and a rope the wire, at a vertex that was sewn to a triangle and to the ground: what is left of
 * nothing waits no more, whether positions were seen between the two changes or not. */
TEST(vertices_of_nothing_wait_no_more) {
    static const uint32_t cloth[6] = {0, 1, 2, 1, 3, 2}, rope[4] = {0, 1, 1, 2}, other[3] = {0, 1, 2};
    static const uint32_t seams[10] = {3, 7, 3, 10, 6, 10, 2, 10, 5, 10};
    static const double up[3] = {0, 0, 1};
    const double x[] = {0, 0, 1, 1, 0, 1, 0, 1, 0, 1, 1, 0, 3, 0, 1, 3, 1,
                        0, 3, 2, 0, 1, 1, 0, 2, 1, 1, 1, 2, 1, 0, 0, 0};
    const cscd_object_desc descs[4] = {cscd_object_of_triangles(4, 2, cloth),
                                       cscd_object_of_wires(3, 2, rope),
                                       cscd_object_of_triangles(3, 1, other), cscd_object_half_space(up)};
    const cscd_object_desc less[2] = {cscd_object_of_triangles(4, 1, cloth),
                                      cscd_object_of_wires(3, 1, rope)};
    const cscd_object_change losses[2] = {{.object = 0, .desc = &less[0]}, {.object = 1, .desc = &less[1]}};
    for (int seen = 0; seen < 2; seen++) {
        cscd_mesh *mesh = NULL;
        cscd_mesh_change *change = NULL;
        cscd_detector *detector = NULL, *fresh = NULL;
        cscd_contacts found, expected;
        assert_int_equal(cscd_context_create(NULL, &scene.context), CSCD_OK);
        expect_ok(cscd_mesh_create(scene.context, descs, 4, &mesh));
        cscd_detector_options options = cscd_detector_defaults();
        options.seams = seams;
        options.seam_count = 5;
        options.seam_reach = (double)INFINITY;
        expect_ok(detector_create_here(mesh, NULL, &options, &detector));
        expect_ok(step_packed(detector, x, x, &found));
        assert_int_equal(found.count, 0);
        expect_ok(cscd_detector_set_seams(detector, NULL, 0));
        if (seen) expect_ok(step_packed(detector, x, x, &found));
        const size_t before = cscd_detector_waiting(detector).features;
        expect_ok(cscd_mesh_change_create(scene.context, mesh, losses, 2, &change));
        expect_ok(cscd_detector_change_mesh(detector, change));
        expect_ok(detector_create_here(cscd_mesh_change_mesh(change), NULL, NULL, &fresh));
        expect_ok(step_packed(fresh, x, x, &expected));
        expect_ok(step_packed(detector, x, x, &found));
        assert_true(found.count == 0 && expected.count > 0);
        assert_int_equal(cscd_detector_waiting(detector).features, expected.count);
        if (seen) assert_true(before > cscd_detector_waiting(detector).features + 2);
        cscd_detector_destroy(fresh);
        cscd_detector_destroy(detector);
        cscd_mesh_change_destroy(change);
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(scene.context);
    }
}
