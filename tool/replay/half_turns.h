/* What turns by about half a turn from one frame to the next: on straight ways it shrinks to next to nothing half-way. */
#pragma once

#include "tool/common/part_names.h"

/* A component that shrinks half-way. */
typedef struct half_turn {
    uint32_t component;
    double
        size; /* half-way: the root mean square distance of its corners from their mean, as a share of that at the ends */
} half_turn;

/* Finds the component that shrinks most between two frames (doubles, xyz of each vertex of the mesh), if one shrinks below 0.59,
 * as a flat thing does that turns by more than 107 degrees, and a ball by more than 161. Returns false: none does, or no memory. */
bool half_turn_find(const cscd_mesh *mesh, const double *x0, const double *x1, half_turn *out);

/* A note for people about the interval from frame k on: "part rotor shrinks to 9 % of its size ...". */
void half_turn_tell(const recording *r, const part_names *parts, uint32_t k, const half_turn *found);
