/* Pairs of triangles that touch along one of the seven directions of 14-DOPs, to the last bit of a double. */
#pragma once

#include "tests/support/random.h"
#include "tests/support/scenes.h"

/* Makes pairs of triangles 2 i and 2 i + 1 with vertices of their own. At both ends the least of one is
 * the greatest of the other along a direction; when that is no double, it is a few units in the last place
 * less. */
void make_touching_pairs(random_stream *random, uint32_t pair_count, double spread, scene *out);
