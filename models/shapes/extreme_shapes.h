/* Shapes that make searches quadratic: very many triangles at one vertex or edge, needles, sheets that almost touch. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* fan        a disc of triangles around its middle
 * cylinder   as CAD programs write it: two such discs, and long triangles between them
 * bipyramid  two vertices at which half of the triangles meet
 * comb       a solid comb, whose teeth are cut into long triangles
 * needles    a flat comb: needles as long as the comb is wide, whose broad ends a spine joins
 * book       triangles around one edge, as pages
 * slivers    long triangles side by side, along the diagonal of their box, that touch nothing
 * spire      a cone of 1,000 times its radius
 * sheets     two flat grids, 1e-9 of their side apart
 * pile       flat sheets of two triangles, as many as there are, each 1e-9 of its side above the one before */
typedef enum extreme_kind {
    EXTREME_FAN,
    EXTREME_CYLINDER,
    EXTREME_BIPYRAMID,
    EXTREME_COMB,
    EXTREME_NEEDLES,
    EXTREME_BOOK,
    EXTREME_SLIVERS,
    EXTREME_SPIRE,
    EXTREME_SHEETS,
    EXTREME_PILE,
    EXTREME_KINDS
} extreme_kind;

/* "fan", "cylinder", ... */
const char *extreme_kind_name(extreme_kind kind);
bool extreme_kind_from_name(const char *name, extreme_kind *out);

typedef struct extreme_shape {
    uint32_t vertex_count, triangle_count;
    uint32_t *triangles; /* three each */
    double *x0, *x1;     /* a small motion, in which hardly anything touches */
} extreme_shape;

/* Makes a shape of about this number of triangles, to be freed. Ends the program where there is no memory. */
extreme_shape extreme_shape_make(extreme_kind kind, uint32_t triangle_count);
void extreme_shape_free(extreme_shape *shape);
