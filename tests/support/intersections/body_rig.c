/* Some bodies, one object each, and what is found where they intersect. */
#include "tests/support/intersections/body_rig.h"

#include "cscd/cscd.h"
#include "src/mesh/triangle_intersection.h"
#include "tests/support/bvh/mesh_trees.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

void body_rig_begin(body_rig *r) {
    scene_clear(&r->all);
    r->body_count = 0;
}

void body_rig_end_body(body_rig *r) {
    body_part *body = &r->bodies[r->body_count];
    const body_part *last = r->body_count > 0 ? &r->bodies[r->body_count - 1] : NULL;
    r->body_count++;
    assert_true(r->body_count <= BODIES_MAX);
    body->first_vertex = last != NULL ? last->first_vertex + last->vertex_count : 0;
    body->first_triangle = last != NULL ? last->first_triangle + last->triangle_count : 0;
    body->vertex_count = r->all.vertex_count - body->first_vertex;
    body->triangle_count = r->all.triangle_count - body->first_triangle;
    for (uint32_t i = 0; i < body->triangle_count * 3; i++)
        body->triangles[i] = r->all.triangles[body->first_triangle * 3 + i] - body->first_vertex;
}

void body_rig_add_box(body_rig *r, const double low[3], const double size[3]) {
    scene *s = &r->all;
    uint32_t first = s->vertex_count;
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (uint32_t v = 0; v < 8; v++, s->vertex_count++) {
        for (uint32_t k = 0; k < 3; k++) s->x0[(first + v) * 3 + k] = low[k] + (v >> k & 1) * size[k];
    }
    for (int i = 0; i < 6; i++) {
        const uint32_t *q = quads[i], corners[6] = {q[0], q[1], q[2], q[0], q[2], q[3]};
        for (uint32_t k = 0; k < 6; k++) s->triangles[s->triangle_count * 3 + k] = first + corners[k];
        s->triangle_count += 2;
    }
}

static size_t list_pairs(body_rig *r) {
    size_t count = 0, capacity = 1024;
    r->pairs = malloc(capacity * sizeof *r->pairs);
    for (uint32_t a = 0; a < r->all.triangle_count; a++) {
        for (uint32_t b = a + 1; b < r->all.triangle_count; b++) {
            if (!triangles_intersect(r->mesh->triangles[a], r->mesh->triangles[b], r->all.x0)) continue;
            if (count == capacity) r->pairs = realloc(r->pairs, (capacity *= 2) * sizeof *r->pairs);
            assert_non_null(r->pairs);
            r->pairs[count++] = (cscd_intersection){a, b};
        }
    }
    return count;
}

void body_rig_find(body_rig *r) {
    cscd_object_desc descs[BODIES_MAX];
    for (uint32_t i = 0; i < r->body_count; i++)
        descs[i] = cscd_object_of_triangles(r->bodies[i].vertex_count, r->bodies[i].triangle_count,
                                            r->bodies[i].triangles);
    assert_int_equal(cscd_context_create(NULL, &r->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r->context, descs, r->body_count, &r->mesh), CSCD_OK);
    mesh_trees_build(r->mesh, r->all.x0, BOX_AXES, &r->trees);
    named_surface surface = {r->mesh, r->all.x0, NULL};
    size_t count = list_pairs(r);
    r->joiner = (curve_joiner){.context = r->context};
    assert_int_equal(curve_joiner_run(&r->joiner, &surface, r->pairs, count, &r->curves), CSCD_OK);
    assert_int_equal(patch_finder_create(r->mesh, 2, &r->finder), CSCD_OK);
    assert_int_equal(patch_finder_run(&r->finder, &surface, &r->trees, r->joiner.found, r->joiner.piece_count,
                                      &r->patches),
                     CSCD_OK);
    r->overlap_finder = (overlap_finder){.context = r->context, .cuts = {.context = r->context}};
    surface_cuts found = {&surface, &r->joiner, &r->finder};
    assert_int_equal(overlap_finder_run(&r->overlap_finder, &found, &r->overlaps), CSCD_OK);
    r->depth_finder = (depth_finder){.context = r->context, .outer = {.context = r->context}};
    r->depth_finder.outer.cuts.context = r->context;
    assert_int_equal(depth_finder_run(&r->depth_finder, &found, &r->trees, &r->depths), CSCD_OK);
}

void body_rig_free(body_rig *r) {
    free(r->pairs);
    depth_finder_free(&r->depth_finder);
    overlap_finder_free(&r->overlap_finder);
    patch_finder_free(&r->finder);
    curve_joiner_free(&r->joiner);
    bvh_free(&r->trees);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

cscd_overlap body_rig_overlap(const body_rig *r, uint32_t a, uint32_t b) {
    for (size_t i = 0; i < r->overlaps.count; i++) {
        if (r->overlaps.items[i].a == a && r->overlaps.items[i].b == b) return r->overlaps.items[i];
    }
    return (cscd_overlap){a, b, 0.0, 0.0, 0.0};
}
