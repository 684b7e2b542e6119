/* Culling by orientation: regions, their detector points, the triangles' flags of an interval. */
#include "runtime/culling/culling.h"

#include <string.h>

static bool allocate(culling *c) {
    cscd_context *context = c->context;
    size_t triangles = c->mesh->triangle_count, regions = c->region_count;
    c->triangle_regions = context_allocate(context, triangles, sizeof *c->triangle_regions);
    c->triangle_weights = context_allocate(context, triangles, sizeof *c->triangle_weights);
    c->detector_offsets = context_allocate(context, regions, sizeof *c->detector_offsets);
    c->detector_points = context_allocate(context, regions, sizeof *c->detector_points);
    c->facing = context_allocate(context, triangles, sizeof *c->facing);
    c->orientations = context_allocate(context, triangles, sizeof *c->orientations);
    c->earlier = context_allocate(context, triangles, sizeof *c->earlier);
    return c->triangle_regions != NULL && c->triangle_weights != NULL && c->detector_offsets != NULL &&
           c->detector_points != NULL && c->facing != NULL && c->orientations != NULL && c->earlier != NULL;
}

cscd_status culling_create(const cscd_mesh *mesh, const cscd_plan *plan, culling *out) {
    culling c = {.context = mesh->context, .mesh = mesh};
    c.region_count = plan != NULL ? plan->region_count : mesh->component_count;
    if (!allocate(&c)) {
        culling_destroy(&c);
        return CSCD_OUT_OF_MEMORY;
    }
    const uint32_t *regions = plan != NULL ? plan->triangle_regions : mesh->triangle_components;
    memcpy(c.triangle_regions, regions, mesh->triangle_count * sizeof *regions);
    for (uint32_t t = 0; plan == NULL && t < mesh->triangle_count; t++)
        c.triangle_weights[t] = 1.0 / mesh->components[mesh->triangle_components[t]].triangle_count;
    if (plan != NULL) {
        memcpy(c.triangle_weights, plan->triangle_weights, mesh->triangle_count * sizeof(double));
        memcpy(c.detector_offsets, plan->detector_offsets, c.region_count * sizeof *c.detector_offsets);
    }
    culling_clear(&c);
    *out = c;
    return CSCD_OK;
}

void culling_destroy(culling *c) {
    void *blocks[] = {c->triangle_regions, c->triangle_weights, c->detector_offsets, c->detector_points,
                      c->facing,           c->orientations,     c->earlier};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(c->context, blocks[i]);
    *c = (culling){0};
}

void culling_join_components(culling *c) {
    uint32_t count = c->mesh->triangle_count, obstacles = 0;
    for (uint32_t t = 0; t < count; t++)
        obstacles += c->triangle_regions[t] = triangle_of_obstacle(c->mesh, t);
    bool both = obstacles > 0 && obstacles < count;
    if (!both) memset(c->triangle_regions, 0, count * sizeof *c->triangle_regions);
    c->region_count = both ? 2 : 1;
}

void culling_clear(culling *c) {
    memset(c->facing, ORIENTATION_ZERO, c->mesh->triangle_count);
    memset(c->orientations, ORIENTATION_ZERO, c->mesh->triangle_count);
    c->plus = c->minus = 0;
}

void culling_begin(culling *c) {
    memcpy(c->orientations, c->facing, c->mesh->triangle_count);
    uint32_t plus = 0, minus = 0;
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) {
        plus += c->facing[t] == ORIENTATION_PLUS;
        minus += c->facing[t] == ORIENTATION_MINUS;
    }
    c->plus = plus;
    c->minus = minus;
}

void culling_pass_done(culling *c) {
    memcpy(c->earlier, c->orientations, c->mesh->triangle_count);
}
