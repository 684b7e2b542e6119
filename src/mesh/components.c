/* Connected components of a mesh and what is wrong with each: holes, fins, bow-ties, flipped triangles. */
#include "src/mesh/mesh.h"

#include "src/core/sort.h"

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
