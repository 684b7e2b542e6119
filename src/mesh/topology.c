/* Edges and stars of a mesh, by counting sorts: linear in its size. */
#include "src/mesh/mesh.h"

#include <string.h>

/* A corner c = 3 * triangle + i stands for the triangle's side from its vertex i to its vertex i + 1. */
static uint32_t corner_vertex(const cscd_mesh *mesh, uint32_t corner) {
    return mesh->triangles[corner / 3][corner % 3];
}

static uint32_t side_end(const cscd_mesh *mesh, uint32_t corner) {
    return mesh->triangles[corner / 3][(corner % 3 + 1) % 3];
}

static uint32_t side_smaller(const cscd_mesh *mesh, uint32_t corner) {
    uint32_t a = corner_vertex(mesh, corner), b = side_end(mesh, corner);
    return a < b ? a : b;
}

static uint32_t side_larger(const cscd_mesh *mesh, uint32_t corner) {
    uint32_t a = corner_vertex(mesh, corner), b = side_end(mesh, corner);
    return a > b ? a : b;
}

/* A stable counting sort of corners by key. in == NULL stands for 0, 1, 2, ... The mesh's vertex_star_offsets end
 * as the bounds of the buckets. */
static void sort_corners(const cscd_mesh *mesh, uint32_t (*key)(const cscd_mesh *, uint32_t),
                         const uint32_t *in, uint32_t *out) {
    uint32_t corner_count = mesh->triangle_count * 3, *offsets = mesh->vertex_star_offsets;
    memset(offsets, 0, ((size_t)mesh->vertex_count + 1) * sizeof *offsets);
    for (uint32_t i = 0; i < corner_count; i++) offsets[key(mesh, in != NULL ? in[i] : i)]++;
    uint32_t sum = 0;
    for (uint32_t v = 0; v <= mesh->vertex_count; v++) {
        uint32_t size = offsets[v];
        offsets[v] = sum;
        sum += size;
    }
    for (uint32_t i = 0; i < corner_count; i++) {
        uint32_t corner = in != NULL ? in[i] : i;
        out[offsets[key(mesh, corner)]++] = corner;
    }
    for (uint32_t v = mesh->vertex_count; v > 0; v--) offsets[v] = offsets[v - 1];
    offsets[0] = 0;
}

static void corners_to_triangles(uint32_t *corners, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) corners[i] /= 3;
}

static bool same_edge(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    return side_smaller(mesh, a) == side_smaller(mesh, b) && side_larger(mesh, a) == side_larger(mesh, b);
}

/* sides lists all corners, with those of one edge next to each other. */
static uint32_t count_edges(const cscd_mesh *mesh, const uint32_t *sides) {
    uint32_t corner_count = mesh->triangle_count * 3, edge_count = corner_count > 0;
    for (uint32_t i = 1; i < corner_count; i++) edge_count += !same_edge(mesh, sides[i - 1], sides[i]);
    return edge_count;
}

static void number_edges(cscd_mesh *mesh, const uint32_t *sides) {
    uint32_t corner_count = mesh->triangle_count * 3, next = 0;
    for (uint32_t i = 0; i < corner_count; i++) {
        if (i == 0 || !same_edge(mesh, sides[i - 1], sides[i])) {
            mesh->edges[next][0] = side_smaller(mesh, sides[i]);
            mesh->edges[next][1] = side_larger(mesh, sides[i]);
            mesh->edge_star_offsets[next++] = i;
        }
        mesh->triangle_edges[sides[i] / 3][sides[i] % 3] = next - 1;
    }
    mesh->edge_star_offsets[next] = corner_count;
}

/* by_larger is scratch: one number per corner. */
static cscd_status build_edges(cscd_mesh *mesh, uint32_t *by_larger) {
    cscd_context *context = mesh->context;
    uint32_t corner_count = mesh->triangle_count * 3;
    array_list by_side = {
        {ARRAY(mesh->edge_stars, corner_count), ARRAY(mesh->triangle_edges, mesh->triangle_count)}};
    if (!context_allocate_all(context, by_side)) return CSCD_OUT_OF_MEMORY;
    uint32_t *sides = mesh->edge_stars;
    sort_corners(mesh, side_larger, NULL, by_larger);
    sort_corners(mesh, side_smaller, by_larger, sides);

    mesh->edge_count = count_edges(mesh, sides);
    array_list by_edge = {
        {ARRAY(mesh->edges, mesh->edge_count), ARRAY(mesh->edge_star_offsets, (size_t)mesh->edge_count + 1)}};
    if (!context_allocate_all(context, by_edge)) return CSCD_OUT_OF_MEMORY;
    number_edges(mesh, sides);
    corners_to_triangles(sides, corner_count);
    return CSCD_OK;
}

static void build_vertex_stars(cscd_mesh *mesh) {
    sort_corners(mesh, corner_vertex, NULL, mesh->vertex_stars);
    corners_to_triangles(mesh->vertex_stars, mesh->triangle_count * 3);
}

/* Offsets by vertex are the only memory that vertices without a triangle cost. */
cscd_status mesh_build_topology(cscd_mesh *mesh) {
    size_t corner_count = (size_t)mesh->triangle_count * 3;
    array_list stars = {{ARRAY(mesh->vertex_stars, corner_count),
                         ARRAY(mesh->vertex_star_offsets, (size_t)mesh->vertex_count + 1)}};
    if (!context_allocate_all(mesh->context, stars)) return CSCD_OUT_OF_MEMORY;
    uint32_t *by_larger = context_allocate(mesh->context, corner_count, sizeof *by_larger);
    if (by_larger == NULL) return CSCD_OUT_OF_MEMORY;
    cscd_status status = build_edges(mesh, by_larger);
    context_free(mesh->context, by_larger);
    if (status == CSCD_OK) build_vertex_stars(mesh);
    return status;
}
