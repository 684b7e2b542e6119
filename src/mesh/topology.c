/* Edges and stars of a mesh: sides of triangles are put to their smaller vertices, and sorted there. */
#include "src/core/sort.h"
#include "src/mesh/mesh.h"

#include <string.h>

/* A corner c = 3 * triangle + i stands for the triangle's side from its vertex i to its vertex i + 1. In the order of
 * these numbers sides go by their larger vertices, and those of one edge by their triangles. */
static uint64_t side_number(uint32_t larger, uint32_t corner) {
    return (uint64_t)larger << 32 | corner;
}

static uint32_t larger_of(uint64_t side) {
    return (uint32_t)(side >> 32);
}

static uint32_t corner_of(uint64_t side) {
    return (uint32_t)side;
}

/* A list for each vertex lies between the mesh's vertex_star_offsets: first of the sides whose smaller vertex it is, and in
 * the end its star. */
typedef struct topology_work {
    cscd_mesh *mesh;
    uint64_t *sides, *spare; /* per corner; spare: where a vertex has many sides, otherwise NULL */
} topology_work;

/* ---- lists of vertices ---------------------------------------------------------------------------------- */

static uint32_t smaller_of(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

/* Turns counts into the beginnings of lists; returns the most. */
static uint32_t begin_lists(uint32_t *counts, uint32_t count) {
    uint32_t sum = 0, most = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t size = counts[i];
        most = size > most ? size : most;
        counts[i] = sum;
        sum += size;
    }
    return most;
}

/* Offsets are counted and moved on one place further, so that in the end each is where its list begins. Returns the length
 * of the longest list. */
static uint32_t list_sides(const topology_work *work) {
    cscd_mesh *mesh = work->mesh;
    uint32_t *next = mesh->vertex_star_offsets + 1;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles[t];
        for (int i = 0; i < 3; i++) next[smaller_of(v[i], v[(i + 1) % 3])]++;
    }
    uint32_t longest = begin_lists(next, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles[t];
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t a = v[i], b = v[(i + 1) % 3];
            work->sides[next[smaller_of(a, b)]++] = side_number(a > b ? a : b, 3 * t + i);
        }
    }
    return longest;
}

static void build_vertex_stars(cscd_mesh *mesh) {
    uint32_t *next = mesh->vertex_star_offsets + 1, corner_count = 3 * mesh->triangle_count;
    const uint32_t *corners = (const uint32_t *)mesh->triangles;
    memset(mesh->vertex_star_offsets, 0, ((size_t)mesh->vertex_count + 1) * sizeof *next);
    for (uint32_t c = 0; c < corner_count; c++) next[corners[c]]++;
    begin_lists(next, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++) mesh->vertex_stars[next[mesh->triangles[t][i]]++] = t;
    }
}

/* ---- edges ---------------------------------------------------------------------------------------------- */

/* Sides are sorted by insertion where they are few. */
enum { INSERTED_MOST = 32 };

static void sort_sides(const topology_work *work, uint32_t begin, uint32_t end) {
    uint64_t *sides = work->sides;
    if (end - begin > INSERTED_MOST) {
        sort_by_number(sides + begin, work->spare + begin, end - begin, sizeof *sides);
        return;
    }
    for (uint32_t i = begin + 1; i < end; i++) {
        uint64_t side = sides[i];
        uint32_t j = i;
        for (; j > begin && sides[j - 1] > side; j--) sides[j] = sides[j - 1];
        sides[j] = side;
    }
}

static bool begins_edge(const uint64_t *sides, uint32_t begin, uint32_t i) {
    return i == begin || larger_of(sides[i - 1]) != larger_of(sides[i]);
}

/* Returns the number of edges. */
static uint32_t sort_all_sides(const topology_work *work) {
    const uint32_t *offsets = work->mesh->vertex_star_offsets;
    uint32_t count = 0;
    for (uint32_t v = 0; v < work->mesh->vertex_count; v++) {
        uint32_t begin = offsets[v], end = offsets[v + 1];
        sort_sides(work, begin, end);
        for (uint32_t i = begin; i < end; i++) count += begins_edge(work->sides, begin, i);
    }
    return count;
}

static void number_edges(const topology_work *work) {
    cscd_mesh *mesh = work->mesh;
    uint32_t next = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t begin = mesh->vertex_star_offsets[v];
        for (uint32_t i = begin; i < mesh->vertex_star_offsets[v + 1]; i++) {
            uint32_t corner = corner_of(work->sides[i]);
            if (begins_edge(work->sides, begin, i)) {
                mesh->edges[next][0] = v;
                mesh->edges[next][1] = larger_of(work->sides[i]);
                mesh->edge_star_offsets[next++] = i;
            }
            mesh->edge_stars[i] = corner / 3;
            mesh->triangle_edges[corner / 3][corner % 3] = next - 1;
        }
    }
    mesh->edge_star_offsets[next] = 3 * mesh->triangle_count;
}

static cscd_status build_edges(topology_work *work) {
    cscd_mesh *mesh = work->mesh;
    mesh->edge_count = sort_all_sides(work);
    array_list arrays = {{ARRAY(mesh->edges, mesh->edge_count),
                          ARRAY(mesh->edge_star_offsets, (size_t)mesh->edge_count + 1),
                          ARRAY(mesh->edge_stars, (size_t)mesh->triangle_count * 3),
                          ARRAY(mesh->triangle_edges, mesh->triangle_count)}};
    if (!context_allocate_all(mesh->context, arrays)) return CSCD_OUT_OF_MEMORY;
    number_edges(work);
    return CSCD_OK;
}

static cscd_status build_all(topology_work *work) {
    cscd_mesh *mesh = work->mesh;
    cscd_context *context = mesh->context;
    if (list_sides(work) > INSERTED_MOST) {
        work->spare = context_reserve(context, (size_t)mesh->triangle_count * 3, sizeof *work->spare);
        if (work->spare == NULL) return CSCD_OUT_OF_MEMORY;
    }
    cscd_status status = build_edges(work);
    context_free(context, work->spare);
    if (status == CSCD_OK) build_vertex_stars(mesh);
    return status;
}

/* Offsets by vertex are the only memory that vertices without a triangle cost. */
cscd_status mesh_build_topology(cscd_mesh *mesh) {
    cscd_context *context = mesh->context;
    size_t corners = (size_t)mesh->triangle_count * 3;
    topology_work work = {.mesh = mesh};
    array_list stars = {{ARRAY(mesh->vertex_stars, corners),
                         ARRAY(mesh->vertex_star_offsets, (size_t)mesh->vertex_count + 1)}};
    if (!context_allocate_all(context, stars)) return CSCD_OUT_OF_MEMORY;
    work.sides = context_reserve(context, corners, sizeof *work.sides);
    if (work.sides == NULL) return CSCD_OUT_OF_MEMORY;
    cscd_status status = build_all(&work);
    context_free(context, work.sides);
    return status;
}
