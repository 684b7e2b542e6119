/* The equations for the charges of one component: its unknowns, and where their potential is known. */
#pragma once

#include "preprocess/charge/potential.h"
#include "src/core/context.h"

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
 * libcscd-baselines know of each other (preprocess/baselines/dense/dense_interface.h). */
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

/* Names of kernels of OpenBLAS, in static storage; see src/blas/blas_choice.h. */
typedef struct charge_kernels {
    const char *used, *better; /* NULL: unknown; used will do */
} charge_kernels;

/* Where the time of a solution went, summed over the components. */
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
