/* What is near on a mesh: the edges at each vertex, where vertices that seams unite are one, and how far rings reach. */
#include "runtime/events/mesh_rings.h"

#include "src/core/disjoint_sets.h"

static array_list list_arrays(const cscd_mesh *mesh, mesh_rings *r) {
    return (array_list){{ARRAY(r->names, mesh->vertex_count),
                         ARRAY(r->offsets, (size_t)mesh->vertex_count + 1),
                         ARRAY(r->neighbours, (size_t)mesh->edge_count * 2)}};
}

static void name_vertices(const cscd_mesh *mesh, const uint32_t *seams, size_t seam_count, uint32_t *names) {
    sets_begin(names, mesh->vertex_count);
    for (size_t i = 0; i < seam_count; i++) set_unite(names, seams[2 * i], seams[2 * i + 1]);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) names[v] = set_root(names, v);
}

/* Counts in offsets[name + 1], adds up, and fills in, which moves each offset to the beginning of the next one. */
static void list_neighbours(const cscd_mesh *mesh, mesh_rings *r) {
    size_t *next = r->offsets + 1, sum = 0;
    for (uint32_t v = 0; v <= mesh->vertex_count; v++) r->offsets[v] = 0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (int k = 0; k < 2; k++) next[r->names[mesh->edges[e][k]]]++;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        size_t count = next[v];
        next[v] = sum;
        sum += count;
    }
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (int k = 0; k < 2; k++)
            r->neighbours[next[r->names[mesh->edges[e][k]]]++] = r->names[mesh->edges[e][1 - k]];
    }
}

cscd_status mesh_rings_create(const cscd_mesh *mesh, uint32_t rings, const uint32_t *seams, size_t seam_count,
                              mesh_rings *out) {
    mesh_rings r = {.same = rings == 0};
    if (!r.same) {
        r.radius = (rings - 1) / 2;
        r.odd = (rings - 1) % 2 == 1;
        if (!context_reserve_all(mesh->context, list_arrays(mesh, &r))) return CSCD_OUT_OF_MEMORY;
        name_vertices(mesh, seams, seam_count, r.names);
        list_neighbours(mesh, &r);
    }
    *out = r;
    return CSCD_OK;
}

void mesh_rings_free(cscd_context *context, mesh_rings *r) {
    context_free(context, r->names);
    context_free(context, r->offsets);
    context_free(context, r->neighbours);
    *r = (mesh_rings){.names = NULL};
}
