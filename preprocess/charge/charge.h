/* The charge of one component: the potential of a triangle, the equations for the unknowns, and another way to solve them. */
#pragma once

#include "src/core/context.h"

#include <stdbool.h>
#include <stddef.h>

/* ---- the potential of a triangle ----------------------------------------------------------------------- */

/* A triangle with a charge of 1 per unit of area, prepared for many points. */
typedef struct potential_source {
    double corners[3][3];
    double along[3][3];   /* l: unit vector of edge i, from corner i to the next */
    double outward[3][3]; /* u = l x n: unit vector in the plane, away from the triangle */
    double lengths[3];
    double normal[3]; /* n */
    double area;
} potential_source;

/* False, and nothing is set, when the triangle's height over its longest edge is below 2^-40 of that edge:
 * its plane is then lost in rounding. */
bool potential_source_set(potential_source *source, const double corners[3][3]);

/* potentials[i] = the integral of dS' / |p_i - r'| over the triangle, p_i = (x[i], y[i], z[i]); finite
 * everywhere, on corners and edges too. Lengths and distances are from 2^-60 to 2^60. Absolute error: some
 * roundings of the triangle's longest edge; relative error at a distance R: some R / (longest edge)
 * roundings. The same bits on every processor. */
void potential_at(const potential_source *source, const double *x, const double *y, const double *z,
                  size_t count, double *potentials);

/* ---- the equations ------------------------------------------------------------------------------------- */

/* Arrays begin on cache lines. */
enum { CHARGE_ALIGNMENT = 64 };

/* A triangle and its collocation point. */
typedef struct charge_point {
    double position[3];
    uint32_t triangle;
    uint32_t unknown;
} charge_point;

/* Unknown k is the charge on a triangle, or on all triangles that coincide with it. Lengths are scaled by a
 * power of two so that the component's extent lies in [1/2, 1), about its box's middle. This is a part of what libcscd and
 * libcscd-baselines know of each other (preprocess/baselines/dense/dense.h). */
typedef struct charge_system {
    uint32_t component, count; /* the number of unknowns */
    uint32_t point_count;      /* the number of triangles with an area */
    double scale;              /* scaled length / length */
    charge_point *points;      /* sorted by position, so by unknown too */
    charge_point *scratch;     /* for sorting */
    potential_source *sources; /* of the unknowns, as all below */
    double *x, *y, *z;         /* collocation points */
    double *charges;           /* at potential 1 in scaled lengths */
} charge_system;

/* Names of kernels of OpenBLAS, in static storage; see preprocess/baselines/dense/blas_choice.h. */
typedef struct charge_kernels {
    const char *used, *better; /* NULL: unknown; used will do */
} charge_kernels;

/* The time of a solution by its stages, summed over the components. */
typedef struct charge_timings {
    double assembly_ms; /* the matrix, or the tree with all that is prepared in it */
    double factor_ms;   /* of the matrix */
    double refine_ms;   /* iterations */
    double total_ms;    /* with all checks and the sorting */
} charge_timings;

/* Takes the next count elements of memory, on a cache line of their own; *used grows, up to SIZE_MAX. memory NULL: it only counts. */
static inline void *charge_take_array(char *memory, size_t *used, size_t count, size_t size) {
    void *taken = memory != NULL ? memory + *used : NULL;
    size_t room = (SIZE_MAX / 2 - *used) / size;
    *used = *used > SIZE_MAX / 2 || count > room
                ? SIZE_MAX
                : (*used + count * size + CHARGE_ALIGNMENT - 1) / CHARGE_ALIGNMENT * CHARGE_ALIGNMENT;
    return taken;
}

/* Points the arrays for up to capacity triangles into memory, which is at least as large as the result; with
 * memory NULL it only counts bytes. SIZE_MAX: too many. */
size_t charge_system_lay_out(charge_system *system, uint32_t capacity, char *memory);

/* The triangles of a mesh, and positions that were checked. */
typedef struct charge_surface {
    cscd_context *context;
    const uint32_t (*triangles)[3];
    const double *positions;
} charge_surface;

/* Takes the component whose triangles are given; ends with unknowns, sources and collocation points. INVALID_ARGUMENT: two triangles
 * have one centroid. */
cscd_status charge_system_collect(charge_system *system, const charge_surface *surface, uint32_t component,
                                  const uint32_t *triangles, uint32_t triangle_count);

/* The density of each triangle, at potential 1 in the caller's lengths; *capacitance is the sum of charges. */
void charge_system_store(const charge_system *system, double *density, double *capacitance);

/* ---- another solution ---------------------------------------------------------------------------------- */

/* A solver to compare with, which takes the place of the tree. */
typedef struct charge_solution {
    const void *functions; /* of the solver, for all of these */
    size_t (*memory)(const void *functions,
                     uint32_t count); /* bytes for this number of unknowns; SIZE_MAX: too many */
    /* Writes system->charges, and adds to the timings. A failure has its sentence. solve NULL: there is no other way. */
    cscd_status (*solve)(const void *functions, cscd_context *context, const charge_system *system,
                         charge_timings *timings);
    charge_kernels (*kernels)(const void *functions);
    double (*work)(double count); /* for this number of unknowns, by estimate: ns on one thread */
} charge_solution;
