/* The bodies of models/shapes for tests, the invariants of their regions, and bodies that bend: what plans for a
 * motion are made for. */
#include "tests/support/models/bodies.h"

#include "preprocess/regions/tiles.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

body body_of(body_kind kind, uint32_t triangle_count) {
    body b;
    io_error error;
    if (!body_make(kind, triangle_count, &b, &error)) fail_msg("%s", error.text);
    return b;
}

/* ---- their meshes and regions -------------------------------------------------------------------------- */

void check_regions(const cscd_mesh *mesh, const uint32_t *regions, uint32_t region_count) {
    uint32_t n = mesh->triangle_count, seen = 0;
    uint32_t *list = malloc(n * sizeof *list), *pieces = malloc(n * sizeof *list);
    uint32_t *scratch = malloc(n * sizeof *list), *components = malloc(n * sizeof *list);
    dual_graph graph;
    expect_ok(dual_graph_build(mesh, &graph));
    for (uint32_t t = 0; t < n; t++) {
        list[t] = t;
        assert_true(regions[t] <= seen && regions[t] < region_count);
        if (regions[t] == seen) components[seen++] = mesh->triangle_components[t];
        assert_int_equal(mesh->triangle_components[t], components[regions[t]]);
    }
    assert_int_equal(seen, region_count);
    assert_int_equal(dual_graph_pieces(&graph, list, n, regions, pieces, scratch), region_count);
    dual_graph_free(mesh, &graph);
    free(list);
    free(pieces);
    free(scratch);
    free(components);
}

cscd_mesh *body_mesh(const body *b, uint32_t thread_count) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = thread_count;
    cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    expect_ok(cscd_context_create(&options, &context));
    expect_ok(cscd_mesh_create(context, &desc, 1, &mesh));
    return mesh;
}

void body_mesh_destroy(cscd_mesh *mesh) {
    cscd_context *context = mesh->context;
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* ---- bodies that bend ---------------------------------------------------------------------------------- */

static int longest_axis(const body *b, double *low, double *length) {
    int longest = 0;
    *length = 0.0;
    for (int k = 0; k < 3; k++) {
        double least = INFINITY, most = -INFINITY;
        for (uint32_t v = 0; v < b->vertex_count; v++) {
            least = fmin(least, b->positions[(size_t)v * 3 + (size_t)k]);
            most = fmax(most, b->positions[(size_t)v * 3 + (size_t)k]);
        }
        if (most - least <= *length) continue;
        *length = most - least;
        *low = least;
        longest = k;
    }
    return longest;
}

/* Makes a body several times as long. */
static void stretch_body(body *b, double times) {
    double low = 0.0, length;
    const int along = longest_axis(b, &low, &length);
    for (uint32_t v = 0; v < b->vertex_count; v++) b->positions[(size_t)v * 3 + (size_t)along] *= times;
}

void bending_bend(const body *b, double angle, double *out) {
    double low = 0.0, length;
    const int along = longest_axis(b, &low, &length), side = (along + 1) % 3, other = (along + 2) % 3;
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        const double *p = b->positions + (size_t)v * 3, at = (p[along] - low) / length - 0.5;
        double *q = out + (size_t)v * 3;
        memcpy(q, p, sizeof(double[3]));
        if (angle == 0.0) continue;
        const double radius = length / angle - p[side];
        q[along] = radius * sin(angle * at);
        q[side] = length / angle - radius * cos(angle * at);
        q[other] = p[other];
    }
}

bending bending_of(body_kind kind, uint32_t triangles, double angle, int threads) {
    bending b = {.shape = body_of(kind, triangles)};
    if (kind == BODY_CAPSULE) stretch_body(&b.shape, 3.0);
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = (uint32_t)threads;
    expect_ok(cscd_context_create(&options, &b.context));
    const cscd_object_desc desc =
        cscd_object_of_triangles(b.shape.vertex_count, b.shape.triangle_count, b.shape.triangles);
    expect_ok(cscd_mesh_create(b.context, &desc, 1, &b.mesh));
    for (int f = 0; f < BENDING_FRAMES; f++) {
        b.frames[f] = body_allocate((size_t)b.shape.vertex_count * 3, sizeof(double));
        bending_bend(&b.shape, angle * f / (BENDING_FRAMES - 1), b.frames[f]);
    }
    return b;
}

const cscd_view *const *bending_frames(bending *b) {
    for (int f = 0; f < BENDING_FRAMES; f++) {
        b->views[f] = cscd_view_doubles(b->frames[f], b->shape.vertex_count);
        b->items[f] = &b->views[f];
    }
    return b->items;
}

void bending_free(bending *b) {
    cscd_mesh_destroy(b->mesh);
    cscd_context_destroy(b->context);
    body_free(&b->shape);
    for (int f = 0; f < BENDING_FRAMES; f++) free(b->frames[f]);
}

cscd_plan *bending_plan(const bending *b, cscd_method method, const cscd_view *const *frames,
                        uint32_t count) {
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.method = method;
    options.frames = frames;
    options.frame_count = count;
    if (cscd_plan_create(b->context, b->mesh, CSCD_DOUBLES(b->shape.positions, b->shape.vertex_count),
                         &options, &plan) != CSCD_OK)
        fail_msg("%s", cscd_context_detail(b->context));
    return plan;
}

void bending_expect_same(const cscd_plan *a, const cscd_plan *b, uint32_t triangles) {
    assert_int_equal(cscd_plan_method(a), cscd_plan_method(b));
    assert_int_equal(cscd_plan_region_count(a), cscd_plan_region_count(b));
    for (uint32_t t = 0; t < triangles; t++)
        assert_int_equal(cscd_plan_triangle_region(a, t), cscd_plan_triangle_region(b, t));
    for (uint32_t r = 0; r < cscd_plan_region_count(a); r++) {
        const cscd_region x = cscd_plan_region(a, r), y = cscd_plan_region(b, r);
        assert_memory_equal(x.detector_point, y.detector_point, sizeof x.detector_point);
    }
}
