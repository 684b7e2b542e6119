/* A context, a mesh and room for the charges of a surface. */
#pragma once

#include "preprocess/preprocess.h"
#include "tests/support/preprocess/charge_shapes.h"

typedef struct charge_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    double *density, *capacitance; /* all -1 at first */
} charge_rig;

extern const charge_options by_dense_system, by_tree, by_coarse_tree;

/* allocator: NULL for the default. */
charge_rig charge_rig_create(const conductor *s, uint32_t thread_count, const cscd_allocator *allocator);

/* Makes a rig and solves for its charges, by the dense system; any failure fails the test. */
charge_rig charge_rig_solve(const conductor *s, uint32_t thread_count);
charge_rig charge_rig_solve_by(const charge_options *options, const conductor *s, uint32_t thread_count);

/* Returns whether density and capacitance are still all -1. */
bool charge_rig_untouched(const charge_rig *r);

void charge_rig_destroy(charge_rig *r);
