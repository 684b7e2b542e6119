/* Triangles of a polygon in a plane, by clipping ears. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Fills a polygon whose corners run counter-clockwise with corner_count - 2 triangles of positive area, without new points.
 * Triangles are three corners each, counted from 0. The polygon is simple, or weakly simple: it may go to a hole and come
 * back on the same way, and may touch itself at corners that lie at one place. Corners on a line are used like any
 * other. False: it crosses or overlaps itself in ways that no such triangles fill, or memory ran out; *out_of_memory says
 * which. Of all ears the one with the shortest diagonal is clipped first, which keeps triangles compact and searches
 * local: n log n for polygons that are not made to be slow. */
bool ear_clipping_fill(const double (*points)[2], uint32_t corner_count, uint32_t (*triangles)[3],
                       bool *out_of_memory);
