/* Whether two detectors have found the same, bit for bit, in all lists that there are. */
#pragma once

#include "cscd/cscd.h"

/* All lists that b has but the overlaps. The patches of single vertices, triangles and corners are of this mesh. */
void compare_surfaces(const cscd_mesh *mesh, const cscd_intersections *a, const cscd_intersections *b);

/* With overlaps, too; an unknown volume equals an unknown one. */
void compare_answers(const cscd_mesh *mesh, const cscd_intersections *a, const cscd_intersections *b);

/* Arrays of items of so many bytes. */
void compare_items(const void *a, size_t a_count, const void *b, size_t b_count, size_t size);
