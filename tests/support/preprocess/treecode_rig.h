/* The equations of a surface that is one component, and the treecode of them. */
#pragma once

#include "preprocess/treecode/source_tree.h"
#include "tests/support/preprocess/charge_shapes.h"

typedef struct treecode_rig {
    cscd_context *context;
    void *memory;
    charge_system system;
    treecode t;
} treecode_rig;

treecode_rig treecode_rig_create(const conductor *s, uint32_t thread_count, cscd_simd simd);
void treecode_rig_destroy(treecode_rig *r);

/* The exact potential at one collocation point, of charges in the order of the tree. */
double treecode_rig_exact_at(const treecode_rig *r, const double *charges, uint32_t target);

/* By how much the potential of the densities differs from 1, in the root of the mean square: what iterations make small. No triangle
 * may be there twice. */
double treecode_rig_residual(treecode_rig *r, const double *density);
