/* Whether two detectors have found the same, bit for bit, in all lists that there are. */
#include "tests/support/intersections/answer_lists.h"

#include "tests/support/test.h"

#include <math.h>

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
