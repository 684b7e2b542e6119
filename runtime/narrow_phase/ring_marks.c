/* A quick proof that two triangles are not near each other on the surface. */
#include "runtime/narrow_phase/ring_marks.h"

#include <string.h>

/* With patches of 128 vertices, a mark of cloth has 1.7 bits in the mean; with smaller patches it has more of them, and larger
 * ones hold more pairs of triangles that are far from each other. Between 32 and 256 vertices it makes little difference. */
enum { PATCH_VERTICES = 128, MARK_BITS = 64 - RING_MARK_FIRST_BIT, UNASSIGNED = 255 };

/* Of the vertices of one object. */
typedef struct vertex_patches {
    const cscd_mesh *mesh;
    uint32_t first_vertex;
    uint8_t *bits;   /* of each vertex's patch */
    uint64_t *rings; /* per vertex: those of all triangles at it */
} vertex_patches;

/* Gives a patch to the free vertices around one of it, up to a number of vertices. */
static uint32_t extend_patch(vertex_patches *p, uint32_t vertex, uint8_t bit, uint32_t *members,
                             uint32_t count) {
    const cscd_mesh *mesh = p->mesh;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        const uint32_t *corners = mesh->triangles[mesh->vertex_stars[i]];
        for (int k = 0; k < 3 && count < PATCH_VERTICES; k++) {
            uint8_t *other = &p->bits[corners[k] - p->first_vertex];
            if (*other != UNASSIGNED) continue;
            *other = bit;
            members[count++] = corners[k];
        }
    }
    return count;
}

/* Lets patches grow from the first free vertex on, one after the other, the nearest vertices first. */
static void cut_patches(vertex_patches *p, uint32_t vertex_count) {
    uint32_t patch = 0, members[PATCH_VERTICES];
    memset(p->bits, UNASSIGNED, vertex_count);
    for (uint32_t v = 0; v < vertex_count; v++) {
        if (p->bits[v] != UNASSIGNED) continue;
        uint8_t bit = (uint8_t)(patch++ % MARK_BITS);
        uint32_t count = 1;
        p->bits[v] = bit;
        members[0] = p->first_vertex + v;
        for (uint32_t next = 0; next < count; next++)
            count = extend_patch(p, members[next], bit, members, count);
    }
}

static uint64_t bit_of_vertex(const vertex_patches *p, uint32_t vertex) {
    return (uint64_t)1 << (RING_MARK_FIRST_BIT + p->bits[vertex - p->first_vertex]);
}

static void collect_rings(vertex_patches *p, const object_range *range, uint64_t *marks) {
    uint32_t begin = range->triangle, end = begin + range->triangle_count;
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])p->mesh->triangles;
    for (uint32_t t = begin; t < end; t++) {
        uint64_t bits = 0;
        for (int k = 0; k < 3; k++) bits |= bit_of_vertex(p, triangles[t][k]);
        for (int k = 0; k < 3; k++) p->rings[triangles[t][k] - p->first_vertex] |= bits;
    }
    for (uint32_t t = begin; t < end; t++) {
        for (int k = 0; k < 3; k++) marks[t] |= p->rings[triangles[t][k] - p->first_vertex];
    }
}

cscd_status ring_marks_add(const cscd_mesh *mesh, const object_range *range, uint64_t *marks) {
    vertex_patches p = {.mesh = mesh, .first_vertex = range->vertex};
    array_list arrays = {{ARRAY(p.bits, range->vertex_count), ARRAY(p.rings, range->vertex_count)}};
    if (range->triangle_count == 0) return CSCD_OK;
    if (!context_allocate_all(mesh->context, arrays)) return CSCD_OUT_OF_MEMORY;
    cut_patches(&p, range->vertex_count);
    collect_rings(&p, range, marks);
    context_free(mesh->context, p.bits);
    context_free(mesh->context, p.rings);
    return CSCD_OK;
}
