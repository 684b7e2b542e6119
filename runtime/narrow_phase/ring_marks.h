/* A quick proof that two triangles are not near each other on the surface. */
#pragma once

#include "src/mesh/mesh_change.h"

/* The ring of a triangle is all triangles that share a vertex with it, itself among them. The vertices of an object are cut
 * into small connected patches, and a mark has a bit for each patch that a vertex of the triangle's ring is in, by the
 * number of the patch modulo 58 (a Bloom filter). Where two marks have no such bit in common, no triangle of the one ring
 * shares a vertex with any of the other. The six lowest bits are free for the caller, and stay as they are. */
enum { RING_MARK_FIRST_BIT = 6 };

static inline bool rings_may_touch(uint64_t mark_a, uint64_t mark_b) {
    return (mark_a & mark_b) >> RING_MARK_FIRST_BIT != 0;
}

/* Adds the bits of the rings to the marks of an object's triangles. */
cscd_status ring_marks_add(const cscd_mesh *mesh, const object_range *range, uint64_t *marks);
