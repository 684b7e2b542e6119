/* The plan: what preprocessing hands to the runtime. */
#include "src/mesh/plan.h"
#include "src/core/names.h"

#include <assert.h>
#include <string.h>

static uint64_t hash_word(uint64_t hash, uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 0xff)) * 0x100000001b3u;
    return hash;
}

/* So that meshes that differ in loose objects alone have different hashes. */
static uint64_t hash_loose_objects(const cscd_mesh *mesh, uint64_t hash) {
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *object = &mesh->objects[i];
        hash = hash_word(hash_word(hash, (uint32_t)object->kind), object->vertex_count);
        for (uint32_t e = 0; object->kind == CSCD_OBJECT_WIRES && e < object->edge_count; e++) {
            for (int k = 0; k < 2; k++) hash = hash_word(hash, mesh->edges[object->first_edge + e][k]);
        }
        for (int k = 0; object->kind == CSCD_OBJECT_HALF_SPACE && k < 3; k++) {
            uint64_t bits;
            memcpy(&bits, &mesh->loose.normals[i][k], sizeof bits);
            hash = hash_word(hash_word(hash, (uint32_t)bits), (uint32_t)(bits >> 32));
        }
    }
    return hash;
}

/* FNV-1a over little-endian words. */
uint64_t cscd_mesh_hash(const cscd_mesh *mesh) {
    uint64_t hash = hash_word(0xcbf29ce484222325u, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++) hash = hash_word(hash, mesh->triangles[t][i]);
    }
    return mesh_has_loose_objects(mesh) ? hash_loose_objects(mesh, hash) : hash;
}

static array_list list_arrays(cscd_plan *plan) {
    const bool charged = method_traits_of(plan->method)->by_charge;
    return (array_list){{ARRAY(plan->triangle_regions, plan->triangle_count),
                         ARRAY(plan->triangle_weights, plan->triangle_count),
                         ARRAY(plan->regions, plan->region_count),
                         ARRAY(plan->detector_offsets, plan->region_count),
                         ARRAY_IF(charged, plan->charges, plan->triangle_count),
                         ARRAY_IF(charged, plan->capacitances, plan->component_count)}};
}

static void free_plan(reference_count *references) {
    cscd_plan *plan = (cscd_plan *)references;
    cscd_context *context = plan->context;
    context_free_all(context, list_arrays(plan));
    context_free(context, plan);
    context_release(context);
}

const char *plan_validate(const cscd_plan *plan) {
    uint64_t triangles = 0;
    for (uint32_t r = 0; r < plan->region_count; r++) {
        triangles += plan->regions[r].triangle_count;
        if (plan->regions[r].component >= plan->component_count)
            return "a region of a plan is of a component that there is not";
    }
    for (uint32_t t = 0; t < plan->triangle_count; t++) {
        if (plan->triangle_regions[t] >= plan->region_count) return "a plan names a region that there is not";
        if (!(plan->triangle_weights[t] >= 0.0 && plan->triangle_weights[t] <= 1.0 + 0x1p-40))
            return "a plan gives a triangle no weight in its region";
    }
    return triangles == plan->triangle_count ? NULL : "the regions of a plan do not hold every triangle once";
}

cscd_plan *plan_allocate(const cscd_mesh *mesh, cscd_method method, uint32_t region_count) {
    cscd_plan *plan = context_allocate(mesh->context, 1, sizeof *plan);
    if (plan == NULL) return NULL;
    plan->context = mesh->context;
    plan->mesh_hash = cscd_mesh_hash(mesh);
    plan->triangle_count = mesh->triangle_count;
    plan->component_count = mesh->component_count;
    plan->region_count = region_count;
    plan->method = method;
    if (!context_allocate_all(mesh->context, list_arrays(plan))) {
        context_free(mesh->context, plan);
        return NULL;
    }
    context_add_object(plan->context, &plan->references, free_plan);
    return plan;
}

void cscd_plan_destroy(cscd_plan *plan) {
    if (plan != NULL) context_destroy_object(plan->context, &plan->references);
}

cscd_region cscd_plan_region(const cscd_plan *plan, uint32_t region) {
    assert(region < plan->region_count);
    return plan->regions[region];
}

const uint32_t *cscd_plan_triangle_regions(const cscd_plan *plan) {
    return plan->triangle_regions;
}

double cscd_plan_triangle_charge(const cscd_plan *plan, uint32_t triangle) {
    assert(triangle < plan->triangle_count);
    return plan->charges != NULL ? plan->charges[triangle] : 0.0;
}

double cscd_plan_capacitance(const cscd_plan *plan, uint32_t component) {
    assert(component < plan->component_count);
    return plan->capacitances != NULL ? plan->capacitances[component] : 0.0;
}

cscd_preprocess_timings cscd_plan_timings(const cscd_plan *plan) {
    return plan->timings;
}

cscd_plan_info cscd_plan_describe(const cscd_plan *plan) {
    cscd_plan_info info = plan->info;
    info.method = plan->method;
    info.region_count = plan->region_count;
    info.compared_count = plan->candidates.count;
    return info;
}

cscd_compared_plan cscd_plan_compared(const cscd_plan *plan, uint32_t place) {
    assert(place < plan->candidates.count);
    cscd_compared_plan found = plan->candidates.items[place];
    if (found.region_count == 0) found.failure = plan->candidates.charge_failure;
    return found;
}
