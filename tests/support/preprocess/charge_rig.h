/* Closed surfaces at any refinement, some with a known capacitance; their charges, and the treecode of their equations. */
#pragma once

#include "models/shapes/extreme_shapes.h"
#include "preprocess/preprocess.h"
#include "preprocess/treecode/source_tree.h"

#include <stdint.h>

/* The caller releases it by conductor_free. */
typedef struct conductor {
    uint32_t vertex_count, triangle_count;
    double *positions;   /* vertex_count * 3 */
    uint32_t *triangles; /* triangle_count * 3 */
} conductor;

/* Makes an icosahedron whose triangles are split in four, level times, with all vertices on the unit
 * sphere. */
conductor conductor_sphere(int level);

/* Makes the unit cube [0,1]^3 with 12 * 4^level triangles. */
conductor conductor_cube(int level);

/* Makes a tetrahedron of four triangles. */
conductor conductor_tetrahedron(void);

/* Makes a shape of about so many long triangles, at rest. */
conductor conductor_extreme(extreme_kind kind, uint32_t triangle_count);

/* Turns every position p into scale * p + offset, coordinate by coordinate. */
void conductor_transform(conductor *s, const double scale[3], const double offset[3]);

/* Moves a unit cube's vertices towards its edges, where the density is infinite: x = (1 - cos(pi x)) / 2. */
void conductor_crowd_edges(conductor *s);

/* Appends b to a, without a common vertex. */
void conductor_append(conductor *a, const conductor *b);

void conductor_free(conductor *s);

/* ---- charges ------------------------------------------------------------------------------------------- */

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

/* ---- treecodes ----------------------------------------------------------------------------------------- */

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
