/* Meshes that cross, and short calls for intersections by kind. */
#include "tests/support/intersections/crossing_scene.h"

#include "runtime/intersections/static_check.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

void make_wavy_spheres(double apart, scene *out) {
    scene_clear(out);
    scene_add_sphere(out, (double[3]){0, 0, 0}, 1.0, 20, 22);
    uint32_t first = out->vertex_count;
    scene_add_sphere(out, (double[3]){0, 0, 0}, 1.0, 20, 22);
    for (uint32_t v = 0; v < out->vertex_count; v++) {
        double *p = out->x0 + (size_t)v * 3, y = p[1], wave = 1.0 + 0.1 * sin(9 * p[0] + 8 * p[1] + 7 * p[2]);
        for (int k = 0; k < 3; k++) p[k] *= wave;
        if (v < first) continue;
        p[1] = 0.6 * y - 0.8 * p[2] + 0.01;
        p[2] = 0.8 * y + 0.6 * p[2];
        p[0] += apart;
    }
    memcpy(out->x1, out->x0, sizeof out->x1);
}

cscd_intersection_options intersection_options(cscd_intersection_answer answer, uint64_t kinds,
                                               size_t stop_after) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.answer = answer;
    options.kinds = kinds;
    options.stop_after = stop_after;
    return options;
}

cscd_intersections find_kinds_of(const scene *s, cscd_detector *detector, cscd_intersection_answer answer,
                                 size_t stop_after) {
    cscd_intersection_options options = intersection_options(answer, UINT64_MAX, stop_after);
    cscd_intersections found;
    expect_ok(find_intersections_packed(detector, s->x0, &options, &found));
    return found;
}

size_t compare_with_each_pair(const scene *s, const cscd_intersections *found) {
    size_t next = 0;
    for (uint32_t a = 0; a < s->triangle_count; a++) {
        for (uint32_t b = a + 1; b < s->triangle_count; b++) {
            pair_kind kind;
            if (!pair_kind_find(s->triangles + (size_t)a * 3, s->triangles + (size_t)b * 3, NULL, s->x0,
                                &kind))
                continue;
            assert_true(next < found->count);
            const cscd_intersection *pair = &found->items[next++];
            assert_true(pair->a == a && pair->b == b && pair->kind == kind.kind &&
                        pair->shared == kind.shared);
        }
    }
    assert_int_equal(next, found->count);
    return next;
}
