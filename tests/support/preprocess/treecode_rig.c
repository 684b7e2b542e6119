/* The equations of a surface that is one component, and the treecode of them. */
#include "tests/support/preprocess/treecode_rig.h"
#include "src/core/system.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>

static cscd_context *make_context(uint32_t threads, cscd_simd simd) {
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context;
    options.thread_count = threads;
    options.simd = simd;
    expect_ok(cscd_context_create(&options, &context));
    return context;
}

treecode_rig treecode_rig_create(const conductor *s, uint32_t thread_count, cscd_simd simd) {
    treecode_rig r = {.context = make_context(thread_count, simd)};
    const charge_surface surface = {r.context, (const uint32_t(*)[3])(const void *)s->triangles,
                                    s->positions};
    uint32_t *list = malloc(s->triangle_count * sizeof *list);
    r.memory = system_memory(charge_system_lay_out(&r.system, s->triangle_count, NULL), CHARGE_ALIGNMENT);
    assert_true(list != NULL && r.memory != NULL);
    for (uint32_t t = 0; t < s->triangle_count; t++) list[t] = t;
    charge_system_lay_out(&r.system, s->triangle_count, r.memory);
    expect_ok(charge_system_collect(&r.system, &surface, 0, list, s->triangle_count));
    free(list);
    expect_ok(treecode_create(r.context, &r.system, &r.t));
    expect_ok(treecode_fill(&r.t));
    return r;
}

void treecode_rig_destroy(treecode_rig *r) {
    treecode_destroy(&r->t);
    cscd_context_destroy(r->context);
    system_memory_free(r->memory);
}

double treecode_rig_residual(treecode_rig *r, const double *density) {
    const charge_system *system = &r->system;
    double *charges = malloc(3 * (size_t)system->count * sizeof *charges), squares = 0.0;
    assert_non_null(charges);
    double *in_order = charges + system->count, *potentials = in_order + system->count;
    for (uint32_t i = 0; i < system->point_count; i++) {
        const charge_point *p = &system->points[i];
        charges[p->unknown] = density[p->triangle] / system->scale * system->sources[p->unknown].area;
    }
    for (uint32_t i = 0; i < system->count; i++) in_order[i] = charges[r->t.tree.sources[i].unknown];
    expect_ok(treecode_evaluate(&r->t, in_order, potentials));
    for (uint32_t i = 0; i < system->count; i++) squares += (potentials[i] - 1.0) * (potentials[i] - 1.0);
    free(charges);
    return sqrt(squares / system->count);
}

double treecode_rig_exact_at(const treecode_rig *r, const double *charges, uint32_t target) {
    const double *p = r->t.tree.sources[target].centroid;
    double sum = 0.0, potential;
    for (uint32_t i = 0; i < r->system.count; i++) {
        const potential_source *triangle = triangle_of(&r->t.tree, i);
        potential_at(triangle, &p[0], &p[1], &p[2], 1, &potential);
        sum += charges[i] / triangle->area * potential;
    }
    return sum;
}
