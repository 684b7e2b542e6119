/* The parts of the static check: kernels that reject most pairs, the exact test of one pair, and the stars of
 * vertices. */
#pragma once

#include "runtime/intersections/intersections.h"
#include "src/core/kernels.h"

/* ---- kernels ------------------------------------------------------------------------------------------- */

/* The answer of sign_normals for a triangle: bit 2k of normals is set if its normal is certainly above zero
 * along axis k, bit 2k + 1 if certainly below. Bit i of rises is set if corner i + 1 lies strictly below
 * corner i along z, and corner i + 2 does not; bit 3 + i says the same of y. */
enum { NORMAL_SIGNS_X = 3, NORMAL_SIGNS_Y = 12, NORMAL_SIGNS_Z = 48, RISES_ALONG_Y = 3 };

typedef struct intersection_kernels {
    /* Removes from a list of pairs of different triangles, in place and without keeping their order, those that
     * certainly do not intersect (see src/mesh/predicates.h) at positions that positions_check has
     * accepted. Pairs that share three vertices do not; they are kept only on demand. Pairs in which an edge certainly
     * passes through the inside of the other face move to crossing, which has room for all. Returns how many are left.
     * All orders are the same on every level. */
    uint32_t (*reject_disjoint)(const uint32_t (*triangles)[3], const double *positions, triangle_pair *pairs,
                                uint32_t count, bool keep_duplicates, triangle_pair *crossing,
                                uint32_t *crossing_count);

    /* Writes for each triangle of a list which signs its normal certainly has, and where its corners rise. A triangle whose
     * normal certainly has a sign has an area. */
    void (*sign_normals)(const uint32_t (*triangles)[3], const double *positions, const uint32_t *list,
                         uint32_t count, uint8_t *normals, uint8_t *rises);
} intersection_kernels;

DECLARE_KERNELS(intersection_kernels);

static inline const intersection_kernels *intersection_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, intersection_kernels);
}

/* ---- one pair ------------------------------------------------------------------------------------------ */

typedef struct pair_kind {
    cscd_intersection_kind kind;
    uint32_t shared; /* corners of the one whose names the other has */
} pair_kind;

/* a and b: the vertices of two different triangles; names: per vertex, vertices of one name count as one, NULL: each is
 * its own; positions: packed. False: they do not intersect in the sense of triangles_intersect, which knows no names,
 * and do not have the same three vertices and an area. *out is written only if they do. The answer is exact. */
bool pair_kind_find(const uint32_t a[3], const uint32_t b[3], const uint32_t *names, const double *positions,
                    pair_kind *out);

/* Counts the corners of the one that have a name of the other: what pair_kind_find writes. */
uint32_t pair_kind_count_shared(const uint32_t a[3], const uint32_t b[3], const uint32_t *names);

/* ---- stars of vertices --------------------------------------------------------------------------------- */

/* On failure *out holds nothing. */
cscd_status vertex_stars_create(const cscd_mesh *mesh, vertex_stars *out);
void vertex_stars_destroy(vertex_stars *s);

/* Sets clear for the vertices begin to end - 1, once normals and rises are those of the moment. */
void vertex_stars_mark_clear(vertex_stars *s, uint32_t begin, uint32_t end);

static inline star_cursor star_cursor_over(uint32_t begin, uint32_t end) {
    return (star_cursor){begin, end, 0, 1};
}

/* Moves on to the next pair of triangles that share a vertex, unless this vertex is clear. Each pair comes
 * once: at the least of its shared vertices. If very many triangles share all of these, the traversal finds
 * the pair (bvh_skip_all_adjacent). False: there is none left. */
bool vertex_stars_next_pair(const vertex_stars *s, star_cursor *cursor, uint32_t pair[2]);
