/* The system of equations for the charges of one component. */
#pragma once

#include "preprocess/charge/charge_interface.h"
#include "preprocess/charge/potential.h"

/* Arrays begin on cache lines. */
enum { CHARGE_ALIGNMENT = 64 };

/* A triangle and its collocation point. */
typedef struct charge_point {
    double position[3];
    uint32_t triangle;
    uint32_t unknown;
} charge_point;

/* Unknown k is the charge on a triangle, or on all triangles that coincide with it. Lengths are scaled by a
 * power of two so that the component's extent lies in [1/2, 1), about its box's middle. */
typedef struct charge_system {
    const charge_problem *problem;
    uint32_t component, count;  /* the number of unknowns */
    uint32_t point_count;       /* the number of triangles with an area */
    double scale;               /* scaled length / length */
    charge_point *points;       /* sorted by position, so by unknown too */
    charge_point *scratch;      /* for sorting */
    potential_source *sources;  /* of the unknowns, as all below */
    double *x, *y, *z;          /* collocation points */
    double *charges, *residual; /* at potential 1 in scaled lengths */
    float *correction;
    int32_t *pivots;
    float *matrix; /* count x count by columns: potential at point j of charge 1 on source k */
} charge_system;

/* Points the arrays for up to capacity triangles into memory, which is at least as large as the result; with
 * memory NULL it only counts bytes. SIZE_MAX: too many. */
size_t charge_system_lay_out(charge_system *system, uint32_t capacity, char *memory);

/* Takes the component whose triangles are given; ends with unknowns, sources and collocation points. */
cscd_status charge_system_collect(charge_system *system, const charge_problem *problem, uint32_t component,
                                  const uint32_t *triangles, uint32_t triangle_count);

/* The estimated cost of a system of so many unknowns, to compare it with others. */
double charge_system_work(uint32_t count);

/* Explains a failure to the host, as printf does, and returns its status. */
cscd_status charge_fail(const charge_problem *problem, cscd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Assembles, factors and solves; adds to timings. CANCELLED: nothing is solved. */
cscd_status charge_system_solve(charge_system *system, charge_timings *timings);
