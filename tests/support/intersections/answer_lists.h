/* Whether two detectors have found the same, bit for bit, in all lists that there are; and short calls for
 * intersections by kind. */
#pragma once

#include "cscd/cscd.h"
#include "cscd/surface.h"
#include "tests/support/scenes.h"

/* All lists that b has but the overlaps. The patches of single vertices, triangles and corners are of this mesh. */
void compare_surfaces(const cscd_mesh *mesh, const cscd_intersections *a, const cscd_intersections *b);

/* With overlaps, too; an unknown volume equals an unknown one. */
void compare_answers(const cscd_mesh *mesh, const cscd_intersections *a, const cscd_intersections *b);

/* Arrays of items of so many bytes. */
void compare_items(const void *a, size_t a_count, const void *b, size_t b_count, size_t size);

/* ---- meshes that cross --------------------------------------------------------------------------------- */

/* Makes two wavy spheres, one turned, which cross at many places unless they are apart. */
void make_wavy_spheres(double apart, scene *out);

cscd_intersection_options intersection_options(cscd_intersection_answer answer, uint64_t kinds,
                                               size_t stop_after);

/* Asks for all kinds; the call must succeed. */
cscd_intersections find_kinds_of(const scene *s, cscd_detector *detector, cscd_intersection_answer answer,
                                 size_t stop_after);

/* Compares a whole list with a test of each pair of triangles; returns how many there are. */
size_t compare_with_each_pair(const scene *s, const cscd_intersections *found);
