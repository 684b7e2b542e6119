/* Labels of parts in a detector that moves over to another mesh, is cloned, is given wrong labels, or has no memory. */
#include "tests/support/calls.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <string.h>

static body_rig rig, other; /* large; one test at a time */
static labelling labels;

/* ---- other meshes, other detectors --------------------------------------------------------------------------- */

/* The first body goes, the second one is turned and keeps all but its first triangle, a new one comes. */
static cscd_mesh_change *change_bodies(const body_rig *r, body_rig *to) {
    static uint32_t triangles[SCENE_TRIANGLES_MAX * 3], origins[SCENE_TRIANGLES_MAX];
    const body_part *ball = &r->bodies[1], *torus = &r->bodies[2];
    for (uint32_t t = 0; t < ball->triangle_count; t++) {
        uint32_t from = ball->triangle_count - 1 - t;
        memcpy(&triangles[t * 3], &ball->triangles[from * 3], 3 * sizeof *triangles);
        origins[t] = from > 0 ? from : UINT32_MAX;
    }
    const cscd_object_desc turned =
        cscd_object_of_triangles(ball->vertex_count, ball->triangle_count, triangles);
    const cscd_object_desc fresh =
        cscd_object_of_triangles(ball->vertex_count, ball->triangle_count, ball->triangles);
    const cscd_object_change changes[3] = {{.object = 0},
                                           {.object = 1, .desc = &turned, .triangle_origins = origins},
                                           {.object = UINT32_MAX, .desc = &fresh}};
    cscd_mesh_change *change = NULL;
    expect_ok(cscd_mesh_change_create(r->context, r->mesh, changes, 3, &change));
    to->all.vertex_count = 2 * ball->vertex_count + torus->vertex_count;
    to->all.triangle_count = cscd_mesh_triangle_count(cscd_mesh_change_mesh(change));
    memcpy(to->all.triangles, cscd_mesh_array(cscd_mesh_change_mesh(change), CSCD_TRIANGLE_VERTICES),
           to->all.triangle_count * 3 * sizeof *to->all.triangles);
    const double *x = r->all.x0 + (size_t)ball->first_vertex * 3;
    uint32_t kept = ball->vertex_count + torus->vertex_count;
    memcpy(to->all.x0, x, (size_t)kept * 3 * sizeof *x);
    for (uint32_t i = 0; i < ball->vertex_count * 3; i++) to->all.x0[kept * 3 + i] = x[i] + 0.15;
    return change;
}

TEST(labels_move_to_another_mesh) {
    static uint32_t before[SCENE_TRIANGLES_MAX];
    uint32_t count;
    labelled_scene_open(&rig, NULL, 2);
    labelling_draw(&labels, &rig, 5, 3);
    labelling_set(&labels, &rig);
    labelled_scene_find(&rig);
    memcpy(before, labels.items, sizeof before);
    cscd_mesh_change *change = change_bodies(&rig, &other);
    const uint32_t *origins = cscd_mesh_change_to_old(change, CSCD_TRIANGLES, &count);
    size_t fresh = 0;
    for (uint32_t t = 0; t < count; t++) {
        fresh += origins[t] == UINT32_MAX;
        labels.items[t] = origins[t] == UINT32_MAX ? UINT32_MAX : before[origins[t]];
    }
    assert_int_equal(fresh, 1 + rig.bodies[1].triangle_count);
    other.detector = rig.detector;
    other.mesh = (cscd_mesh *)cscd_mesh_change_mesh(change);
    expect_ok(cscd_detector_change_mesh(rig.detector, change));
    labelled_scene_find(&other);
    assert_true(labelling_compare(&labels, &other) > 10);
    expect_ok(cscd_detector_set_parts(rig.detector, NULL, 0));
    labelled_scene_find(&other);
    for (uint32_t t = 0; t < count; t++) {
        uint32_t corners[3];
        cscd_mesh_triangle(other.mesh, t, corners);
        labels.items[t] = cscd_mesh_vertex_object(other.mesh, corners[0]);
    }
    labels.count = 3;
    assert_true(labelling_compare(&labels, &other) >= 5);
    cscd_mesh_change_destroy(change);
}

/* A small ball comes, so that there are triangles with larger numbers than ever before. */
TEST(sums_follow_to_a_larger_mesh) {
    static const double centre[3] = {0.95, 0.25, 0.15};
    counting_allocator counter = counting_allocator_start();
    labelled_scene_open(&rig, NULL, 1);
    rig.counter = &counter;
    body_rig_create(&rig, NULL, 1);
    labelling_draw(&labels, &rig, 5, 8);
    labelling_set(&labels, &rig);
    labelled_scene_find(&rig);
    cscd_mesh *before = rig.mesh;
    scene_add_sphere(&rig.all, centre, 0.5, 6, 9);
    body_rig_end_body(&rig);
    const body_part *ball = &rig.bodies[3];
    const cscd_object_desc desc =
        cscd_object_of_triangles(ball->vertex_count, ball->triangle_count, ball->triangles);
    const cscd_object_change come = {.object = UINT32_MAX, .desc = &desc};
    cscd_mesh_change *change = NULL;
    expect_ok(cscd_mesh_change_create(rig.context, before, &come, 1, &change));
    expect_ok(cscd_detector_change_mesh(rig.detector, change));
    rig.mesh = (cscd_mesh *)cscd_mesh_change_mesh(change);
    for (uint32_t t = 0; t < ball->triangle_count; t++) labels.items[ball->first_triangle + t] = UINT32_MAX;
    labelled_scene_find(&rig);
    assert_true(labelling_compare(&labels, &rig) > 15);
    rig.mesh = before;
    cscd_mesh_change_destroy(change);
    body_rig_free(&rig);
    assert_int_equal(counter.live, 0);
}

TEST(clones_have_their_own_labels) {
    cscd_detector *first, *second;
    labelled_scene_open(&rig, NULL, 1);
    labelling_draw(&labels, &rig, 6, 4);
    labelling_set(&labels, &rig);
    first = rig.detector;
    expect_ok(cscd_detector_clone(rig.context, first, &second));
    expect_ok(cscd_detector_set_parts(first, NULL, 0));
    rig.detector = second;
    labelled_scene_find(&rig);
    labelling_compare(&labels, &rig);
    labelling_of_objects(&labels, &rig);
    rig.detector = first;
    labelled_scene_find(&rig);
    assert_int_equal(labelling_compare(&labels, &rig), 5);
    cscd_detector_destroy(second);
}

/* ---- calls ------------------------------------------------------------------------------------------------ */

TEST(what_is_refused) {
    labelled_scene_open(&rig, NULL, 1);
    labelling_draw(&labels, &rig, 3, 5);
    labelling_set(&labels, &rig);
    labels.items[17] = 3;
    assert_int_equal(cscd_detector_set_parts(rig.detector, labels.items, 3), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(rig.context),
                        "triangle 17 has the label 3, but there are 3 parts: a label is below that, or "
                        "UINT32_MAX for none");
    assert_int_equal(cscd_detector_set_parts(rig.detector, labels.items, 0), CSCD_INVALID_ARGUMENT);
    expect_invalid(rig.context, cscd_detector_set_parts(rig.detector, NULL, 3), "labels is NULL");
    assert_int_equal(cscd_detector_set_parts(NULL, NULL, 0), CSCD_NULL_OBJECT);
    labelling_draw(&labels, &rig, 3, 5); /* those that it has still */
    labelled_scene_find(&rig);
    labelling_compare(&labels, &rig);
}

AROUND_EACH(NULL, body_rigs_free)
