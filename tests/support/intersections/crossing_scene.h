/* Meshes that cross, and short calls for intersections by kind. */
#pragma once

#include "cscd/surface.h"
#include "tests/support/scenes.h"

/* Makes two wavy spheres, one turned, which cross at many places unless they are apart. */
void make_wavy_spheres(double apart, scene *out);

cscd_intersection_options intersection_options(cscd_intersection_answer answer, uint64_t kinds,
                                               size_t stop_after);

/* Asks for all kinds; the call must succeed. */
cscd_intersections find_kinds_of(const scene *s, cscd_detector *detector, cscd_intersection_answer answer,
                                 size_t stop_after);

/* Compares a whole list with a test of each pair of triangles; returns how many there are. */
size_t compare_with_each_pair(const scene *s, const cscd_intersections *found);
