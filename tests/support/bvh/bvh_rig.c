/* A BVH over a scene's mesh; any failure to make it fails the test. */
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/test.h"

#include <stdlib.h>

static void choose_regions(bvh_rig *r, uint32_t region_count) {
    const cscd_mesh *mesh = r->mesh;
    uint32_t most = mesh->triangle_count;
    r->region_count = region_count == 0 ? mesh->component_count : region_count < most ? region_count : most;
    r->regions = malloc(mesh->triangle_count * sizeof *r->regions);
    assert_non_null(r->regions);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        r->regions[t] = region_count == 0 ? mesh->triangle_components[t]
                                          : (uint32_t)((uint64_t)t * r->region_count / mesh->triangle_count);
}

static void build_trees(bvh_rig *r, const double *positions, int axis_count) {
    uint32_t count = r->mesh->triangle_count;
    double *weights = malloc(count * sizeof *weights), *sizes = calloc(r->region_count, sizeof *sizes);
    assert_true(weights != NULL && sizes != NULL);
    for (uint32_t t = 0; t < count; t++) sizes[r->regions[t]] += 1.0;
    for (uint32_t t = 0; t < count; t++) weights[t] = 1.0 / sizes[r->regions[t]];
    bvh_regions regions = {r->regions, weights, r->region_count};
    assert_int_equal(bvh_build(r->mesh, regions, positions, axis_count, &r->bvh), CSCD_OK);
    free(weights);
    free(sizes);
}

bool bvh_rig_create(const scene *s, bvh_setup setup, bvh_rig *out) {
    bvh_rig r = {.context = NULL};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = setup.thread_count;
    options.simd = setup.simd;
    cscd_status status = cscd_context_create(&options, &r.context);
    if (setup.simd != CSCD_SIMD_AUTO && !processor_has_simd(setup.simd)) {
        assert_int_equal(status, CSCD_INVALID_ARGUMENT);
        return false;
    }
    assert_int_equal(status, CSCD_OK);
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    assert_int_equal(cscd_mesh_create(r.context, &desc, 1, &r.mesh), CSCD_OK);
    choose_regions(&r, setup.region_count);
    build_trees(&r, s->x0, setup.axis_count);
    *out = r;
    return true;
}

void bvh_rig_destroy(bvh_rig *r) {
    bvh_free(&r->bvh);
    free(r->regions);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

void translate(double *x, uint32_t vertex_count, const double by[3]) {
    for (size_t i = 0; i < (size_t)vertex_count * 3; i++) x[i] += by[i % 3];
}

void in_frame(const bvh *hierarchy, const bvh_tree *p, gap_motion m, uint32_t vertex, int moment,
              long double out[3]) {
    long double t = 0.5L * moment;
    for (size_t k = 0; k < 3; k++) {
        size_t at = (size_t)vertex * 3 + k;
        const bvh_tree *frame = p != NULL ? p : &hierarchy->trees[0];
        long double start = (long double)m.x0[at] - frame->origin[0][k];
        long double end = (long double)m.x1[at] - frame->origin[1][k];
        out[k] = ((1.0L - t) * start + t * end) * hierarchy->scale;
    }
}
