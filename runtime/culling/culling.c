/* Culling by orientation: regions, their detector points, and the orientations of triangles in an interval. */
#include "runtime/culling/culling.h"

#include <string.h>

array_list culling_arrays(culling *c) {
    size_t triangles = c->mesh->triangle_count, regions = c->region_count;
    return (array_list){{ARRAY(c->triangle_regions, triangles), ARRAY(c->triangle_weights, triangles),
                         ARRAY(c->detector_offsets, regions), ARRAY(c->detector_points, regions),
                         ARRAY(c->facing, triangles), ARRAY(c->orientations, triangles),
                         ARRAY(c->earlier, triangles)}};
}

cscd_status culling_create(const cscd_mesh *mesh, const cscd_plan *plan, culling *out) {
    culling c = {.context = mesh->context, .mesh = mesh};
    c.region_count = plan != NULL ? plan->region_count : mesh->component_count;
    if (!context_allocate_all(c.context, culling_arrays(&c))) return CSCD_OUT_OF_MEMORY;
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
    context_free_all(c->context, culling_arrays(c));
    *c = (culling){0};
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
