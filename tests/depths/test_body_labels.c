/* Bodies of one object: parts that are closed, components, or what labels of their own say. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static body_rig rig; /* large; one test at a time */

static cscd_depths find_as(uint32_t object_count, const uint32_t *labels, uint32_t part_count,
                           cscd_context *context, cscd_mesh **mesh, cscd_detector **detector) {
    cscd_object_desc descs[2];
    for (uint32_t i = 0; i < 2; i++)
        descs[i] = cscd_object_of_triangles(rig.bodies[i].vertex_count, rig.bodies[i].triangle_count,
                                            rig.bodies[i].triangles);
    if (object_count == 1)
        descs[0] = cscd_object_of_triangles(rig.all.vertex_count, rig.all.triangle_count, rig.all.triangles);
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.depths = options.parts = options.part_bodies = true;
    assert_int_equal(cscd_mesh_create(context, descs, object_count, mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(context, *mesh, NULL, NULL, detector), CSCD_OK);
    assert_int_equal(cscd_detector_set_parts(*detector, labels, part_count), CSCD_OK);
    assert_int_equal(cscd_detector_find_intersections(
                         *detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count), &options, &found),
                     CSCD_OK);
    return *found.depths;
}

/* A ball that is sunk 0.1 into a slab; labels: 0 for the slab's triangles, `ball` for the ball's. */
static void sink_ball(uint32_t *labels, uint32_t ball) {
    const double low[3] = {-2, -2, -1}, size[3] = {4, 4, 1}, centre[3] = {0.1, 0.2, 0.4};
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    scene_add_sphere(&rig.all, centre, 0.5, 16, 24);
    body_rig_end_body(&rig);
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) labels[t] = t < 12 ? 0 : ball;
}

static double greatest_depth(const cscd_depths *depths) {
    double most = 0.0;
    for (size_t i = 0; i < depths->count; i++) most = fmax(most, depths->items[i].depth);
    return most;
}

/* A ball that is sunk 0.1 into a slab: as two objects, as two parts of one, without parts, and as two parts that have triangles of both:
 * then the surface under the ball is within the body, and the way out is longer. */
TEST(a_part_is_a_body_if_it_is_closed) {
    static uint32_t labels[SCENE_TRIANGLES_MAX];
    cscd_context *context;
    cscd_mesh *meshes[4];
    cscd_detector *detectors[4];
    sink_ball(labels, UINT32_MAX);
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    const cscd_depths objects = find_as(2, NULL, 0, context, &meshes[0], &detectors[0]);
    const cscd_depths parts = find_as(1, labels, 1, context, &meshes[1], &detectors[1]);
    assert_int_equal(cscd_detector_body_labels(detectors[0], NULL), 2);
    assert_int_equal(cscd_detector_body_labels(detectors[1], labels), 2);
    assert_int_equal(objects.count, parts.count);
    assert_true(objects.count > 10);
    for (size_t i = 0; i < objects.count; i++)
        assert_memory_equal(&objects.items[i], &parts.items[i], sizeof objects.items[i]);
    assert_true(fabs(greatest_depth(&objects) - 0.1) < 1e-12);
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) {
        assert_int_equal(labels[t], t < 12 ? 0 : 1);
        labels[t] = t % 2; /* both parts have triangles of both components */
    }
    const cscd_depths one = find_as(1, labels, 2, context, &meshes[2], &detectors[2]);
    assert_int_equal(cscd_detector_body_labels(detectors[2], labels), 1);
    assert_true(greatest_depth(&one) > 0.2);
    const cscd_depths alone = find_as(1, NULL, 0, context, &meshes[3], &detectors[3]);
    assert_int_equal(cscd_detector_body_labels(detectors[3], NULL), 2);
    assert_int_equal(cscd_detector_body_labels(detectors[3], labels), 2);
    assert_int_equal(objects.count, alone.count);
    assert_memory_equal(objects.items, alone.items, objects.count * sizeof *objects.items);
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) assert_int_equal(labels[t], t < 12 ? 0 : 1);
    for (int i = 0; i < 4; i++) {
        cscd_detector_destroy(detectors[i]);
        cscd_mesh_destroy(meshes[i]);
    }
    cscd_context_destroy(context);
}

/* A box that lies askew in a slab's surface, its two halves being parts: each has a deepest point, the patch names the deeper one. */
TEST(parts_of_a_patch_have_their_own_points) {
    static const double low[3] = {-4, -4, -2}, size[3] = {8, 8, 2}, small[3] = {-1, -1, -0.25},
                        sizes[3] = {2, 2, 1};
    static uint32_t labels[SCENE_TRIANGLES_MAX];
    for (int turned = 0; turned < 2; turned++) {
        cscd_context *context;
        cscd_mesh *mesh;
        cscd_detector *detector;
        double deepest[2] = {0.0, 0.0}, most = 0.0;
        size_t points[2] = {0, 0};
        body_rig_begin(&rig);
        body_rig_add_box(&rig, low, size);
        body_rig_end_body(&rig);
        body_rig_add_box(&rig, small, sizes);
        body_rig_end_body(&rig);
        for (uint32_t v = 8; v < 16; v++) /* one side is 0.1 deeper */
            rig.all.x0[3 * v + 2] -= (v % 2 == 1) == (turned == 0) ? 0.1 : 0.0;
        for (uint32_t t = 0; t < 24; t++) {
            const uint32_t *c = rig.all.triangles + 3 * (size_t)t;
            const uint32_t to_the_right = c[0] % 2 + c[1] % 2 + c[2] % 2;
            const bool right =
                to_the_right > (turned == 0 ? 0 : 2); /* no corner of the other part is as deep */
            labels[t] = t < 12 ? 0 : right ? 2 : 1;
        }
        assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
        const cscd_depths found = find_as(2, labels, 3, context, &mesh, &detector);
        for (size_t i = found.vertex_count + found.edge_count; i < found.count; i++) {
            const cscd_depth *at = &found.items[i];
            if (at->face < 12) continue;
            const uint32_t part = labels[at->face] - 1;
            deepest[part] = fmax(deepest[part], at->depth);
            points[part]++;
        }
        assert_true(points[0] == 1 && points[1] == 1);
        assert_true(fabs(deepest[turned == 0] - 0.35) < 1e-12 && fabs(deepest[turned == 1] - 0.25) < 1e-12);
        for (size_t i = 0; i < found.patch_count; i++)
            most = fmax(most, found.items[found.patches[i].deepest].depth);
        assert_true(most == fmax(deepest[0], deepest[1]));
        cscd_detector_destroy(detector);
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(context);
    }
}

static double depth_of(cscd_detector *detector) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.depths = options.parts = options.part_bodies = true;
    assert_int_equal(cscd_detector_find_intersections(
                         detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count), &options, &found),
                     CSCD_OK);
    return greatest_depth(found.depths);
}

/* Another ball comes into the mesh, which is a body of its own. */
static void check_changed_bodies(cscd_detector *detector, const cscd_mesh *mesh, const uint32_t *before) {
    static uint32_t bodies[SCENE_TRIANGLES_MAX];
    const body_part *ball = &rig.bodies[1];
    const cscd_object_desc desc =
        cscd_object_of_triangles(ball->vertex_count, ball->triangle_count, ball->triangles);
    const cscd_object_change come = {.object = UINT32_MAX, .desc = &desc};
    cscd_mesh_change *change = NULL;
    assert_int_equal(cscd_mesh_change_create(cscd_mesh_context(mesh), mesh, &come, 1, &change), CSCD_OK);
    assert_int_equal(cscd_detector_change_mesh(detector, change), CSCD_OK);
    assert_int_equal(cscd_detector_body_labels(detector, bodies), 3);
    assert_memory_equal(bodies, before, rig.all.triangle_count * sizeof *bodies);
    for (uint32_t t = 0; t < ball->triangle_count; t++)
        assert_int_equal(bodies[rig.all.triangle_count + t], 2);
    cscd_mesh_change_destroy(change);
}

/* The same ball and slab, of which two parts have triangles of both: what belongs together is said apart, to a clone and after a change
 * of the mesh, too. */
TEST(bodies_have_labels_of_their_own) {
    static uint32_t parts[SCENE_TRIANGLES_MAX], bodies[SCENE_TRIANGLES_MAX], told[SCENE_TRIANGLES_MAX];
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector, *clone;
    sink_ball(bodies, 1);
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) parts[t] = t % 2;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    const cscd_depths one = find_as(1, parts, 2, context, &mesh, &detector);
    assert_true(greatest_depth(&one) > 0.2);
    assert_int_equal(cscd_detector_set_bodies(detector, bodies, 2), CSCD_OK);
    assert_int_equal(cscd_detector_body_labels(detector, told), 2);
    assert_memory_equal(told, bodies, rig.all.triangle_count * sizeof *told);
    assert_true(fabs(depth_of(detector) - 0.1) < 1e-12);
    bodies[3] = 2;
    assert_int_equal(cscd_detector_set_bodies(detector, bodies, 2), CSCD_INVALID_ARGUMENT);
    assert_string_equal(
        cscd_context_detail(context),
        "triangle 3 has the label 2, but there are 2 parts: a label is below that, or UINT32_MAX for none");
    assert_int_equal(cscd_detector_set_bodies(detector, NULL, 2), CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(context), "cscd_detector_set_bodies: labels is NULL"));
    assert_int_equal(cscd_detector_clone(context, detector, &clone), CSCD_OK);
    assert_int_equal(cscd_detector_set_bodies(detector, NULL, 0), CSCD_OK);
    assert_true(depth_of(detector) > 0.2);
    assert_true(fabs(depth_of(clone) - 0.1) < 1e-12);
    check_changed_bodies(clone, mesh, told);
    cscd_detector_destroy(clone);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}
