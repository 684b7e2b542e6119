/* A context, a mesh and room for the charges of a surface. */
#pragma once

#include "preprocess/charge_call.h"
#include "tests/support/preprocess/charge_shapes.h"

typedef struct charge_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    double *density, *capacitance; /* all -1 at first */
} charge_rig;

/* allocator: NULL for the default. */
charge_rig charge_rig_create(const conductor *s, uint32_t thread_count, const cscd_allocator *allocator);

/* Makes a rig and solves for its charges; any failure fails the test. */
charge_rig charge_rig_solve(const conductor *s, uint32_t thread_count);

/* Returns whether density and capacitance are still all -1. */
bool charge_rig_untouched(const charge_rig *r);

void charge_rig_destroy(charge_rig *r);
