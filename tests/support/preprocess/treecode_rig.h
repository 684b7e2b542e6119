/* The equations of a surface that is one component, and the treecode of them. */
#pragma once

#include "preprocess/treecode/treecode.h"
#include "tests/support/preprocess/charge_shapes.h"

typedef struct treecode_rig {
    cscd_context *context;
    void *memory;
    charge_system system;
    treecode t;
} treecode_rig;

treecode_rig treecode_rig_create(const conductor *s, uint32_t thread_count, cscd_simd simd);
void treecode_rig_destroy(treecode_rig *r);

/* By how much the potential of the densities differs from 1, in the root of the mean square: what iterations make small. No triangle
 * may be there twice. */
double treecode_rig_residual(treecode_rig *r, const double *density);
