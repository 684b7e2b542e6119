/* Nearest points and rays of a set of triangles, against each triangle by itself. */
#include "runtime/ccd/ccd.h"
#include "runtime/untangle/triangle_set.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <math.h>

typedef struct set_rig {
    scene shape;
    cscd_context *context;
    cscd_mesh *mesh;
    triangle_set set;
    uint32_t triangles[SCENE_TRIANGLES_MAX], count;
} set_rig;

static set_rig rig;

/* Every second triangle of a scene. */
static void open_rig(scene_family family, uint64_t seed) {
    scene_make(family, seed, &rig.shape);
    const cscd_object_desc object =
        cscd_object_of_triangles(rig.shape.vertex_count, rig.shape.triangle_count, rig.shape.triangles);
    expect_ok(cscd_context_create(NULL, &rig.context));
    expect_ok(cscd_mesh_create(rig.context, &object, 1, &rig.mesh));
    rig.set = (triangle_set){.context = rig.context};
    rig.count = 0;
    for (uint32_t t = 0; t < rig.shape.triangle_count; t += 2) rig.triangles[rig.count++] = t;
}

static void close_rig(void) {
    triangle_set_free(&rig.set);
    cscd_mesh_destroy(rig.mesh);
    cscd_context_destroy(rig.context);
}

static const double *corner_at(uint32_t triangle, int k) {
    return rig.shape.x0 + 3 * (size_t)rig.shape.triangles[3 * (size_t)triangle + (size_t)k];
}

static double nearest_of_all(const double p[3]) {
    double least = (double)INFINITY;
    for (uint32_t i = 0; i < rig.count; i++) {
        double u, v;
        const uint32_t t = rig.triangles[i];
        least =
            fmin(least, closest_point_triangle(p, corner_at(t, 0), corner_at(t, 1), corner_at(t, 2), &u, &v));
    }
    return sqrt(least);
}

/* The point of the place, by its weights. */
static void point_of(const set_place *place, double out[3]) {
    for (int k = 0; k < 3; k++) {
        out[k] = 0.0;
        for (int c = 0; c < 3; c++) out[k] += place->weights[c] * corner_at(place->triangle, c)[k];
    }
}

static void expect_nearest(const double p[3]) {
    const set_place place = triangle_set_nearest(&rig.set, p);
    double q[3], squared = 0.0;
    point_of(&place, q);
    for (int k = 0; k < 3; k++) squared += (p[k] - q[k]) * (p[k] - q[k]);
    assert_true(fabs(place.distance - nearest_of_all(p)) < 1e-12);
    assert_true(fabs(place.distance - sqrt(squared)) < 1e-9);
}

TEST(nearest_places_are_those_of_all_triangles) {
    random_stream stream = stream_start(1);
    for (uint64_t seed = 1; seed <= 3; seed++) {
        open_rig(SCENE_NOISY_SPHERE, seed);
        for (size_t questions = 1; questions <= 100; questions += 99) { /* without a tree, and with one */
            assert_true(
                triangle_set_make(&rig.set, rig.mesh, rig.shape.x0, rig.triangles, rig.count, questions));
            for (int i = 0; i < 100; i++) {
                const double p[3] = {stream_between(&stream, -2, 2), stream_between(&stream, -2, 2),
                                     stream_between(&stream, -2, 2)};
                expect_nearest(p);
            }
        }
        close_rig();
    }
}

TEST(rays_meet_the_farthest_triangle) {
    random_stream stream = stream_start(2);
    size_t hits = 0;
    open_rig(SCENE_NESTED_SPHERES, 1);
    rig.count = 0;
    for (uint32_t t = 0; t < rig.shape.triangle_count; t++) rig.triangles[rig.count++] = t;
    assert_true(triangle_set_make(&rig.set, rig.mesh, rig.shape.x0, rig.triangles, rig.count, 100));
    triangle_set alone = {.context = rig.context};
    for (int i = 0; i < 50; i++) {
        double direction[3], length = 0.0, farthest = 0.0;
        const double p[3] = {stream_between(&stream, -0.8, 0.8), stream_between(&stream, -0.8, 0.8),
                             stream_between(&stream, -0.8, 0.8)};
        for (int k = 0; k < 3; k++) {
            direction[k] = stream_between(&stream, -1, 1);
            length += direction[k] * direction[k];
        }
        for (int k = 0; k < 3; k++) direction[k] /= sqrt(length);
        const set_place found = triangle_set_farthest_hit(&rig.set, p, direction);
        for (uint32_t t = 0; t < rig.count; t++) {
            assert_true(triangle_set_make(&alone, rig.mesh, rig.shape.x0, &t, 1, 1));
            farthest = fmax(farthest, triangle_set_farthest_hit(&alone, p, direction).distance);
        }
        assert_true(found.distance == farthest);
        assert_true((found.triangle == UINT32_MAX) == (farthest == 0.0));
        hits += found.triangle != UINT32_MAX;
    }
    assert_in_range(hits, 10, 49);
    triangle_set_free(&alone);
    close_rig();
}

TEST(empty_sets_have_no_places) {
    open_rig(SCENE_NOISY_SPHERE, 1);
    const double p[3] = {0.0, 0.0, 0.0}, along[3] = {1.0, 0.0, 0.0};
    assert_true(triangle_set_make(&rig.set, rig.mesh, rig.shape.x0, rig.triangles, 0, 10));
    assert_int_equal(triangle_set_nearest(&rig.set, p).triangle, UINT32_MAX);
    assert_int_equal(triangle_set_farthest_hit(&rig.set, p, along).triangle, UINT32_MAX);
    close_rig();
}
