/* A context, a mesh and room for the charges of a surface. */
#include "tests/support/preprocess/charge_rig.h"
#include "tests/support/test.h"

#include <stdlib.h>

const charge_options by_dense_system = {CSCD_CHARGE_DENSE, 0}, by_tree = {CSCD_CHARGE_TREE, 0},
                     by_coarse_tree = {CSCD_CHARGE_COARSE, 0};

charge_rig charge_rig_create(const conductor *s, uint32_t thread_count, const cscd_allocator *allocator) {
    charge_rig r = {NULL, NULL, NULL, NULL};
    cscd_context_options options = cscd_context_defaults();
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    options.thread_count = thread_count;
    if (allocator != NULL) options.allocator = *allocator;
    expect_ok(cscd_context_create(&options, &r.context));
    expect_ok(cscd_mesh_create(r.context, &desc, 1, &r.mesh));
    uint32_t components = cscd_mesh_component_count(r.mesh);
    r.density = malloc(s->triangle_count * sizeof *r.density);
    r.capacitance = malloc(components * sizeof *r.capacitance);
    assert_non_null(r.density);
    assert_non_null(r.capacitance);
    for (uint32_t t = 0; t < s->triangle_count; t++) r.density[t] = -1.0;
    for (uint32_t c = 0; c < components; c++) r.capacitance[c] = -1.0;
    return r;
}

charge_rig charge_rig_solve(const conductor *s, uint32_t thread_count) {
    return charge_rig_solve_by(&by_dense_system, s, thread_count);
}

charge_rig charge_rig_solve_by(const charge_options *options, const conductor *s, uint32_t thread_count) {
    charge_rig r = charge_rig_create(s, thread_count, NULL);
    if (charge_solve(r.mesh, s->positions, options, r.density, r.capacitance, NULL) != CSCD_OK)
        fail_msg("%s", cscd_context_detail(r.context));
    return r;
}

bool charge_rig_untouched(const charge_rig *r) {
    bool untouched = true;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(r->mesh); t++)
        untouched = untouched && r->density[t] == -1.0;
    for (uint32_t c = 0; c < cscd_mesh_component_count(r->mesh); c++)
        untouched = untouched && r->capacitance[c] == -1.0;
    return untouched;
}

void charge_rig_destroy(charge_rig *r) {
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    free(r->density);
    free(r->capacitance);
    *r = (charge_rig){NULL, NULL, NULL, NULL};
}
