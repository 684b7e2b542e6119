/* The mesh object of the public API: validation, copy, access. */
#include "src/mesh.h"

#include <string.h>

/* Corners are numbered by 32 bits: 3 * triangle_count must fit. */
enum { TRIANGLE_COUNT_MAX = (int)(UINT32_MAX / 3) };

static cscd_status check_triangle(cscd_context *context, const cscd_mesh_desc *desc, uint32_t triangle) {
    const uint32_t *v = desc->triangles + (size_t)triangle * 3;
    for (int i = 0; i < 3; i++) {
        if (v[i] >= desc->vertex_count)
            return context_fail(context, CSCD_INVALID_MESH,
                                "triangle %u names vertex %u, but there are %u vertices", triangle, v[i],
                                desc->vertex_count);
    }
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
        return context_fail(context, CSCD_INVALID_MESH,
                            "triangle %u (%u %u %u) repeats a vertex; remove it or weld differently",
                            triangle, v[0], v[1], v[2]);
    return CSCD_OK;
}

static cscd_status check_desc(cscd_context *context, const cscd_mesh_desc *desc) {
    if (desc->vertex_count == 0 || desc->triangle_count == 0)
        return context_fail(context, CSCD_INVALID_MESH, "the mesh is empty: %u vertices, %u triangles",
                            desc->vertex_count, desc->triangle_count);
    if (desc->triangle_count > TRIANGLE_COUNT_MAX)
        return context_fail(context, CSCD_INVALID_MESH, "%u triangles are too many: the ceiling is %d",
                            desc->triangle_count, TRIANGLE_COUNT_MAX);
    if (desc->vertex_count == UINT32_MAX)
        return context_fail(context, CSCD_INVALID_MESH, "%u vertices are too many: the ceiling is one less",
                            desc->vertex_count);
    if (desc->triangles == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_mesh_desc.triangles is NULL");
    for (uint32_t t = 0; t < desc->triangle_count; t++) {
        cscd_status status = check_triangle(context, desc, t);
        if (status != CSCD_OK) return status;
    }
    return CSCD_OK;
}

static cscd_status copy_triangles(cscd_mesh *mesh, const cscd_mesh_desc *desc) {
    mesh->vertex_count = desc->vertex_count;
    mesh->triangle_count = desc->triangle_count;
    mesh->triangles = context_allocate(mesh->context, desc->triangle_count, sizeof *mesh->triangles);
    if (mesh->triangles == NULL) return CSCD_OUT_OF_MEMORY;
    memcpy(mesh->triangles, desc->triangles, (size_t)desc->triangle_count * sizeof *mesh->triangles);
    return CSCD_OK;
}

cscd_status cscd_mesh_create(cscd_context *context, const cscd_mesh_desc *desc, cscd_mesh **out) {
    if (context == NULL) return CSCD_INVALID_ARGUMENT;
    if (desc == NULL || out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_mesh_create: desc or out is NULL");
    cscd_status status = check_desc(context, desc);
    if (status != CSCD_OK) return status;

    cscd_mesh *mesh = context_allocate(context, 1, sizeof *mesh);
    if (mesh == NULL) return context_out_of_memory(context);
    mesh->context = context;
    status = copy_triangles(mesh, desc);
    if (status == CSCD_OK) status = mesh_build_topology(mesh);
    if (status == CSCD_OK) status = mesh_build_components(mesh);
    if (status != CSCD_OK) {
        cscd_mesh_destroy(mesh);
        return context_out_of_memory(context);
    }
    *out = mesh;
    return CSCD_OK;
}

void cscd_mesh_destroy(cscd_mesh *mesh) {
    if (mesh == NULL) return;
    cscd_context *context = mesh->context;
    void *blocks[] = {mesh->triangles,      mesh->edges,
                      mesh->triangle_edges, mesh->vertex_star_offsets,
                      mesh->vertex_stars,   mesh->edge_star_offsets,
                      mesh->edge_stars,     mesh->triangle_components,
                      mesh->components,     mesh};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
}

uint32_t cscd_mesh_vertex_count(const cscd_mesh *mesh) {
    return mesh->vertex_count;
}

uint32_t cscd_mesh_triangle_count(const cscd_mesh *mesh) {
    return mesh->triangle_count;
}

void cscd_mesh_triangle(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertices[3]) {
    memcpy(vertices, mesh->triangles[triangle], sizeof mesh->triangles[triangle]);
}

uint32_t cscd_mesh_edge_count(const cscd_mesh *mesh) {
    return mesh->edge_count;
}

void cscd_mesh_edge(const cscd_mesh *mesh, uint32_t edge, uint32_t vertices[2]) {
    memcpy(vertices, mesh->edges[edge], sizeof mesh->edges[edge]);
}

uint32_t cscd_mesh_component_count(const cscd_mesh *mesh) {
    return mesh->component_count;
}

cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component) {
    return mesh->components[component];
}

uint32_t cscd_mesh_triangle_component(const cscd_mesh *mesh, uint32_t triangle) {
    return mesh->triangle_components[triangle];
}
