/* Is the surface embedded at one moment? All meeting triangle pairs, by exact predicates. */
#pragma once

#include "src/mesh/mesh.h"

/* What one thread finds. */
typedef struct intersection_lane {
    _Alignas(CACHE_LINE_SIZE) cscd_intersection *items;
    size_t count, capacity;
    uint32_t zero_area_triangles, first_zero_area;
    bool out_of_memory;
} intersection_lane;

/* Compares the triangles that detector->suspects marks with one another, as they are at positions, in the
 * component that they share, and tells the detector's start states. The tree's volumes contain the triangles
 * at that moment: of the moment, or of an interval that it is part of. */
cscd_status static_check_suspects(cscd_detector *detector, const double *positions);
