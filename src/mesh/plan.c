/* The plan: what preprocessing hands to the runtime. */
#include "src/mesh/plan.h"

static uint64_t hash_word(uint64_t hash, uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 0xff)) * 0x100000001b3u;
    return hash;
}

/* FNV-1a over little-endian words. */
uint64_t cscd_mesh_hash(const cscd_mesh *mesh) {
    uint64_t hash = hash_word(0xcbf29ce484222325u, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++) hash = hash_word(hash, mesh->triangles[t][i]);
    }
    return hash;
}

cscd_plan *plan_allocate(const cscd_mesh *mesh, cscd_method method, uint32_t region_count) {
    cscd_context *context = mesh->context;
    cscd_plan *plan = context_allocate(context, 1, sizeof *plan);
    if (plan == NULL) return NULL;
    plan->context = context;
    plan->mesh_hash = cscd_mesh_hash(mesh);
    plan->triangle_count = mesh->triangle_count;
    plan->component_count = mesh->component_count;
    plan->region_count = region_count;
    plan->method = method;
    plan->triangle_regions = context_allocate(context, mesh->triangle_count, sizeof *plan->triangle_regions);
    plan->triangle_weights = context_allocate(context, mesh->triangle_count, sizeof *plan->triangle_weights);
    plan->regions = context_allocate(context, region_count, sizeof *plan->regions);
    plan->detector_offsets = context_allocate(context, region_count, sizeof *plan->detector_offsets);
    bool allocated = plan->triangle_regions != NULL && plan->triangle_weights != NULL &&
                     plan->regions != NULL && plan->detector_offsets != NULL;
    if (allocated && method == CSCD_METHOD_CHARGE) {
        plan->charges = context_allocate(context, mesh->triangle_count, sizeof *plan->charges);
        plan->capacitances = context_allocate(context, mesh->component_count, sizeof *plan->capacitances);
        allocated = plan->charges != NULL && plan->capacitances != NULL;
    }
    if (allocated) return plan;
    cscd_plan_destroy(plan);
    return NULL;
}

void cscd_plan_destroy(cscd_plan *plan) {
    if (plan == NULL) return;
    cscd_context *context = plan->context;
    void *blocks[] = {plan->triangle_regions, plan->triangle_weights, plan->regions, plan->detector_offsets,
                      plan->charges,          plan->capacitances,     plan};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
}

cscd_method cscd_plan_method(const cscd_plan *plan) {
    return plan->method;
}

uint32_t cscd_plan_region_count(const cscd_plan *plan) {
    return plan->region_count;
}

cscd_region cscd_plan_region(const cscd_plan *plan, uint32_t region) {
    return plan->regions[region];
}

uint32_t cscd_plan_triangle_region(const cscd_plan *plan, uint32_t triangle) {
    return plan->triangle_regions[triangle];
}

double cscd_plan_triangle_charge(const cscd_plan *plan, uint32_t triangle) {
    return plan->charges != NULL ? plan->charges[triangle] : 0.0;
}

double cscd_plan_capacitance(const cscd_plan *plan, uint32_t component) {
    return plan->capacitances != NULL ? plan->capacitances[component] : 0.0;
}

cscd_preprocess_timings cscd_plan_timings(const cscd_plan *plan) {
    return plan->timings;
}
