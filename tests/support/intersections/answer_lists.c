/* Whether two detectors have found the same, bit for bit, in all lists that there are; and short calls for
 * intersections by kind. */
#include "tests/support/intersections/answer_lists.h"

#include "runtime/intersections/static_check.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

void compare_items(const void *a, size_t a_count, const void *b, size_t b_count, size_t size) {
    assert_int_equal(a_count, b_count);
    if (a_count > 0) assert_memory_equal(a, b, a_count * size);
}

static void compare_curves(const cscd_curves *a, const cscd_curves *b) {
    compare_items(a->items, a->count, b->items, b->count, sizeof *a->items);
    compare_items(a->points, a->point_count, b->points, b->point_count, sizeof *a->points);
    compare_items(a->pieces, a->piece_count, b->pieces, b->piece_count, sizeof *a->pieces);
    compare_items(a->pair_curves, a->pair_count, b->pair_curves, b->pair_count, sizeof *a->pair_curves);
}

static void compare_patches(const cscd_mesh *mesh, const cscd_patches *a, const cscd_patches *b) {
    size_t vertices = cscd_mesh_vertex_count(mesh), triangles = cscd_mesh_triangle_count(mesh);
    compare_items(a->items, a->count, b->items, b->count, sizeof *a->items);
    compare_items(a->windings, a->winding_count, b->windings, b->winding_count, sizeof *a->windings);
    compare_items(a->vertex_patches, vertices, b->vertex_patches, vertices, sizeof *a->vertex_patches);
    compare_items(a->triangle_patches, triangles, b->triangle_patches, triangles,
                  sizeof *a->triangle_patches);
    compare_items(a->corner_patches, 3 * triangles, b->corner_patches, 3 * triangles,
                  sizeof *a->corner_patches);
}

static void compare_depths(const cscd_depths *a, const cscd_depths *b) {
    assert_int_equal(a->vertex_count, b->vertex_count);
    compare_items(a->items, a->count, b->items, b->count, sizeof *a->items);
    compare_items(a->patches, a->patch_count, b->patches, b->patch_count, sizeof *a->patches);
}

static void compare_cut_offs(const cscd_cut_offs *a, const cscd_cut_offs *b) {
    compare_items(a->items, a->count, b->items, b->count, sizeof *a->items);
    compare_items(a->patches, a->patch_count, b->patches, b->patch_count, sizeof *a->patches);
}

static void compare_parts(const cscd_part_pairs *a, const cscd_part_pairs *b) {
    compare_items(a->items, a->count, b->items, b->count, sizeof *a->items);
    assert_int_equal(a->faces, b->faces);
    assert_true(a->share == b->share);
}

void compare_surfaces(const cscd_mesh *mesh, const cscd_intersections *a, const cscd_intersections *b) {
    compare_items(a->items, a->count, b->items, b->count, sizeof *a->items);
    assert_int_equal(a->zero_area_triangles, b->zero_area_triangles);
    if (b->curves != NULL) compare_curves(a->curves, b->curves);
    if (b->patches != NULL) compare_patches(mesh, a->patches, b->patches);
    if (b->depths != NULL) compare_depths(a->depths, b->depths);
    if (b->cut_offs != NULL) compare_cut_offs(a->cut_offs, b->cut_offs);
    if (b->parts != NULL) compare_parts(a->parts, b->parts);
}

void compare_answers(const cscd_mesh *mesh, const cscd_intersections *a, const cscd_intersections *b) {
    compare_surfaces(mesh, a, b);
    if (b->overlaps == NULL) return;
    assert_int_equal(a->overlaps->count, b->overlaps->count);
    for (size_t i = 0; i < a->overlaps->count; i++) {
        const cscd_overlap *p = &a->overlaps->items[i], *q = &b->overlaps->items[i];
        assert_true(p->a == q->a && p->b == q->b && p->area_a == q->area_a && p->area_b == q->area_b);
        assert_true(p->volume == q->volume || (isnan(p->volume) && isnan(q->volume)));
    }
}

/* ---- meshes that cross --------------------------------------------------------------------------------- */

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
