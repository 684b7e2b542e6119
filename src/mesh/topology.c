/* Edges, stars and connected components of a mesh, and what is wrong with each: holes, fins, bow-ties, flipped triangles. */
#include "src/mesh/mesh.h"

#include "src/core/sort.h"

#include <string.h>

/* Sides of triangles are put to their smaller vertices, and sorted there.
 *
 * A corner c = 3 * triangle + i stands for the triangle's side from its vertex i to its vertex i + 1. In the order of
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

/* ---- components -------------------------------------------------------------------------------------------- */

static uint32_t *single_sets(cscd_context *context, uint32_t count) {
    uint32_t *parents = context_allocate(context, count, sizeof *parents);
    if (parents != NULL) sets_begin(parents, count);
    return parents;
}

/* Numbers components in the order of their first triangles; triangles that share a vertex are in one
 * component. */
static cscd_status number_components(cscd_mesh *mesh) {
    mesh->triangle_components = context_allocate(mesh->context, mesh->triangle_count, sizeof(uint32_t));
    uint32_t *parents = single_sets(mesh->context, mesh->triangle_count);
    if (mesh->triangle_components == NULL || parents == NULL) {
        context_free(mesh->context, parents);
        return CSCD_OUT_OF_MEMORY;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (uint32_t i = mesh->vertex_star_offsets[v] + 1; i < mesh->vertex_star_offsets[v + 1]; i++)
            set_unite(parents, mesh->vertex_stars[i - 1], mesh->vertex_stars[i]);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t root = set_root(parents, t);
        mesh->triangle_components[t] = root == t ? mesh->component_count++ : mesh->triangle_components[root];
    }
    context_free(mesh->context, parents);
    return CSCD_OK;
}

static void count_one(uint32_t *count, uint32_t *first, uint32_t feature) {
    if ((*count)++ == 0) *first = feature;
}

static uint32_t corner_at(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertex) {
    const uint32_t *v = mesh->triangles[triangle];
    return triangle * 3 + (v[0] == vertex ? 0u : v[1] == vertex ? 1u : 2u);
}

static void count_edge(const cscd_mesh *mesh, uint32_t edge) {
    const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[edge];
    const uint32_t *ends = mesh->edges[edge];
    uint32_t size = edge_star_size(mesh, edge);
    if (size == 0) return; /* a wire */
    cscd_component *component = &mesh->components[mesh->triangle_components[star[0]]];
    component->edge_count++;
    if (size == 1) count_one(&component->open_edges, &component->first_open_edge, edge);
    if (size > 2) count_one(&component->non_manifold_edges, &component->first_non_manifold_edge, edge);
    if (size == 2 && triangle_runs_along(mesh->triangles[star[0]], ends) ==
                         triangle_runs_along(mesh->triangles[star[1]], ends))
        count_one(&component->inconsistent_edges, &component->first_inconsistent_edge, edge);
}

/* Unites the corners of neighbouring triangles at both ends of each edge: a vertex with one fan keeps one
 * set. */
static void unite_fans(const cscd_mesh *mesh, uint32_t *parents) {
    for (uint32_t edge = 0; edge < mesh->edge_count; edge++) {
        const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[edge];
        for (uint32_t i = 1; i < edge_star_size(mesh, edge); i++) {
            for (int end = 0; end < 2; end++) {
                uint32_t vertex = mesh->edges[edge][end];
                set_unite(parents, corner_at(mesh, star[i - 1], vertex), corner_at(mesh, star[i], vertex));
            }
        }
    }
}

static void count_vertex(const cscd_mesh *mesh, uint32_t vertex, uint32_t *parents) {
    const uint32_t *star = mesh->vertex_stars + mesh->vertex_star_offsets[vertex];
    uint32_t size = mesh->vertex_star_offsets[vertex + 1] - mesh->vertex_star_offsets[vertex];
    if (size == 0) return;
    cscd_component *component = &mesh->components[mesh->triangle_components[star[0]]];
    component->vertex_count++;
    uint32_t fan = set_root(parents, corner_at(mesh, star[0], vertex));
    for (uint32_t i = 1; i < size; i++) {
        if (set_root(parents, corner_at(mesh, star[i], vertex)) == fan) continue;
        count_one(&component->non_manifold_vertices, &component->first_non_manifold_vertex, vertex);
        return;
    }
}

static void finish_component(cscd_component *component) {
    component->euler_characteristic =
        (int64_t)component->vertex_count - component->edge_count + component->triangle_count;
    component->closed_manifold = component->open_edges == 0 && component->non_manifold_edges == 0 &&
                                 component->non_manifold_vertices == 0 && component->inconsistent_edges == 0;
}

cscd_status mesh_build_components(cscd_mesh *mesh) {
    cscd_status status = number_components(mesh);
    if (status != CSCD_OK) return status;
    mesh->components = context_allocate(mesh->context, mesh->component_count, sizeof *mesh->components);
    uint32_t *parents = single_sets(mesh->context, mesh->triangle_count * 3);
    if (mesh->components == NULL || parents == NULL) {
        context_free(mesh->context, parents);
        return CSCD_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < mesh->component_count; i++) {
        cscd_component *component = &mesh->components[i];
        component->first_open_edge = component->first_non_manifold_edge = UINT32_MAX;
        component->first_non_manifold_vertex = component->first_inconsistent_edge = UINT32_MAX;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        mesh->components[mesh->triangle_components[t]].triangle_count++;
    for (uint32_t edge = 0; edge < mesh->edge_count; edge++) count_edge(mesh, edge);
    unite_fans(mesh, parents);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) count_vertex(mesh, v, parents);
    for (uint32_t i = 0; i < mesh->component_count; i++) finish_component(&mesh->components[i]);
    context_free(mesh->context, parents);
    return CSCD_OK;
}

void mesh_list_by_component(const cscd_mesh *mesh, uint32_t *list, uint32_t *offsets) {
    for (uint32_t t = 0; t < mesh->triangle_count; t++) offsets[mesh->triangle_components[t] + 1]++;
    for (uint32_t c = 0; c < mesh->component_count; c++) offsets[c + 1] += offsets[c];
    for (uint32_t t = 0; t < mesh->triangle_count; t++) list[offsets[mesh->triangle_components[t]]++] = t;
    for (uint32_t c = mesh->component_count; c > 0; c--) offsets[c] = offsets[c - 1];
    offsets[0] = 0;
}
