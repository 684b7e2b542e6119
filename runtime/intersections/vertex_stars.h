/* Pairs of triangles that share a vertex. Most stars are seen as a whole not to intersect themselves. */
#pragma once

#include "src/mesh/mesh.h"

/* What the kernel sign_normals says of a triangle: bit 2k of normals is set if its normal is certainly above zero along
 * axis k, bit 2k + 1 if certainly below. Bit i of rises is set if corner i + 1 lies strictly below corner i along z, and
 * corner i + 2 does not; bit 3 + i says the same of y. */
enum { NORMAL_SIGNS_X = 3, NORMAL_SIGNS_Y = 12, NORMAL_SIGNS_Z = 48, RISES_ALONG_Y = 3 };

/* What is known of the stars at one moment. */
typedef struct vertex_stars {
    const cscd_mesh *mesh;
    bool *closed; /* per vertex: each edge at it belongs to two triangles, which run through it in opposite
                   * directions; whatever the moment */
    bool *clear;  /* per vertex: no two triangles at it intersect, nor are they duplicates; or nobody wants
                   * to know */
    uint8_t *normals, *rises; /* per triangle */
} vertex_stars;

/* Where a thread is in its share of the vertices: the pair that comes next is that of two triangles of a star. */
typedef struct star_cursor {
    uint32_t vertex, end, first, second;
} star_cursor;

/* On failure *out holds nothing. */
cscd_status vertex_stars_create(const cscd_mesh *mesh, vertex_stars *out);
void vertex_stars_destroy(vertex_stars *s);

/* Sets clear for the vertices begin to end - 1, once normals and rises are those of the moment. */
void vertex_stars_mark_clear(vertex_stars *s, uint32_t begin, uint32_t end);

static inline star_cursor star_cursor_over(uint32_t begin, uint32_t end) {
    return (star_cursor){begin, end, 0, 1};
}

/* Moves on to the next pair of triangles that share a vertex, but none that is clear. A pair comes once in all: at the least
 * of these vertices. Where very many triangles share all of these, the traversal finds it (bvh_skip_all_adjacent). False: there is none left. */
bool vertex_stars_next_pair(const vertex_stars *s, star_cursor *cursor, uint32_t pair[2]);
