/* Where an edge passes through a triangle, in the limit of a symbolic perturbation that goes to 0. */
#pragma once

#include "runtime/intersections/curve_piece.h"

typedef struct event_point {
    double s;    /* the point is (1-s) e0 + s e1 on the edge (e0, e1) */
    double u, v; /* and (1-u-v) p0 + u p1 + v p2 on the triangle */
    double x[3];
} event_point;

/* The event happens. Each number is rounded once, to nearest, from its exact value. An end at a vertex has the parameters 0. */
void event_point_find(const named_surface *s, surface_event event, event_point *out);

/* The same, by integers alone. */
void event_point_find_exactly(const named_surface *s, surface_event event, event_point *out);
