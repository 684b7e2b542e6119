/* A mesh at rest: lengths of edges, by which a barrier judges whether two of them are nearly parallel, and areas, by which
 * pairs of features weigh. */
#include "runtime/detector/rest_shape.h"

#include "src/core/vec3.h"

#include <string.h>

/* Between these, 1e-3 times a fourth power neither over- nor underflows. */
static const double shortest = 0x1p-250, longest = 0x1p250;

static double squared_length_of(const cscd_mesh *mesh, const double *x, uint32_t edge) {
    const uint32_t *ends = mesh->edges[edge];
    return vec3_squared_distance(x + (size_t)ends[0] * 3, x + (size_t)ends[1] * 3);
}

static cscd_status check_lengths(cscd_context *context, const cscd_mesh *mesh, const double *squared) {
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        double length = sqrt(squared[e]);
        if (length == 0.0 || (length >= shortest && length <= longest)) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "edge %u is %g long at rest, expected 0 or a length from 2^-250 to 2^250", e,
                            length);
    }
    return CSCD_OK;
}

static double area_of_triangle(const cscd_mesh *mesh, const double *x, uint32_t triangle) {
    const uint32_t *corners = mesh->triangles[triangle];
    const double *origin = x + (size_t)corners[0] * 3;
    double u[3], v[3], across[3];
    vec3_subtract(x + (size_t)corners[1] * 3, origin, u);
    vec3_subtract(x + (size_t)corners[2] * 3, origin, v);
    vec3_cross(u, v, across);
    return 0.5 * sqrt(vec3_dot(across, across));
}

/* ---- areas of vertices and edges ------------------------------------------------------------------------ */

/* Adds halves of the lengths of wires to their vertices; a vertex of nothing is a point. */
static void add_wires(const cscd_mesh *mesh, const rest_shape *r) {
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        if (!edge_is_loose(mesh, e)) continue;
        r->edge_areas[e] = sqrt(r->squared_lengths[e]);
        for (int i = 0; i < 2; i++) r->vertex_areas[mesh->edges[e][i]] += 0.5 * r->edge_areas[e];
    }
}

static void mark_points(const cscd_mesh *mesh, const rest_shape *r) {
    for (uint32_t e = mesh->edge_count; e < mesh->edge_count + mesh->loose.point_count; e++)
        r->vertex_areas[mesh->edges[e][0]] = 1.0;
}

/* Sums up in the order of the numbers, so that areas have the same bits in every copy. There is room. */
static void share_areas(const cscd_mesh *mesh, const rest_shape *r) {
    memset(r->vertex_areas, 0, mesh->vertex_count * sizeof *r->vertex_areas);
    memset(r->edge_areas, 0, mesh->edge_count * sizeof *r->edge_areas);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++) {
            r->vertex_areas[mesh->triangles[t][i]] += r->triangle_areas[t] / 3.0;
            r->edge_areas[mesh->triangle_edges[t][i]] += r->triangle_areas[t] / 3.0;
        }
    }
    add_wires(mesh, r);
    mark_points(mesh, r);
}

/* ---- life ----------------------------------------------------------------------------------------------- */

static array_list list_arrays(rest_shape *r, const cscd_mesh *mesh) {
    return (array_list){{ARRAY(r->squared_lengths, mesh->edge_count),
                         ARRAY(r->triangle_areas, mesh->triangle_count),
                         ARRAY(r->vertex_areas, mesh->vertex_count), ARRAY(r->edge_areas, mesh->edge_count)}};
}

cscd_status rest_shape_set(cscd_context *context, const cscd_mesh *mesh, const double *positions,
                           rest_shape *r) {
    rest_shape fresh = {.squared_lengths = NULL};
    if (!context_allocate_all(context, list_arrays(&fresh, mesh))) return context_out_of_memory(context);
    for (uint32_t e = 0; e < mesh->edge_count; e++)
        fresh.squared_lengths[e] = squared_length_of(mesh, positions, e);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        fresh.triangle_areas[t] = area_of_triangle(mesh, positions, t);
    cscd_status status = check_lengths(context, mesh, fresh.squared_lengths);
    if (status != CSCD_OK) {
        rest_shape_free(context, &fresh);
        return status;
    }
    share_areas(mesh, &fresh);
    rest_shape_free(context, r);
    *r = fresh;
    return CSCD_OK;
}

/* Vertices of one origin are at one place at rest, so an edge is as long as its origin. */
static void move_lengths(const rest_shape *r, const cscd_mesh_change *change, double *moved) {
    for (uint32_t i = 0; i < change->run_count; i++) {
        const object_run *run = &change->runs[i];
        if (run->from.edge_count > 0)
            memcpy(moved + run->to.edge, r->squared_lengths + run->from.edge,
                   run->from.edge_count * sizeof *moved);
    }
    for (uint32_t i = 0; i < change->described_count; i++) {
        const object_range *range = &change->described[i];
        for (uint32_t e = range->edge; e < range->edge + range->edge_count; e++) {
            uint32_t origin = change->edges.to_old[e];
            moved[e] = origin != UINT32_MAX ? r->squared_lengths[origin] : 0.0;
        }
    }
}

static void move_areas(const rest_shape *r, const cscd_mesh_change *change, double *moved) {
    for (uint32_t i = 0; i < change->run_count; i++) {
        const object_run *run = &change->runs[i];
        if (run->from.triangle_count > 0)
            memcpy(moved + run->to.triangle, r->triangle_areas + run->from.triangle,
                   run->from.triangle_count * sizeof *moved);
    }
    for (uint32_t i = 0; i < change->described_count; i++) {
        const object_range *range = &change->described[i];
        for (uint32_t t = range->triangle; t < range->triangle + range->triangle_count; t++) {
            uint32_t origin = change->triangles.to_old[t];
            moved[t] = origin != UINT32_MAX ? r->triangle_areas[origin] : 0.0;
        }
    }
}

cscd_status rest_shape_move(const rest_shape *r, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            rest_shape *out) {
    *out = (rest_shape){NULL};
    if (r->squared_lengths == NULL) return CSCD_OK;
    if (!context_allocate_all(mesh->context, list_arrays(out, mesh))) return CSCD_OUT_OF_MEMORY;
    move_lengths(r, change, out->squared_lengths);
    move_areas(r, change, out->triangle_areas);
    share_areas(mesh, out);
    return CSCD_OK;
}

cscd_status rest_shape_copy(const rest_shape *r, const cscd_mesh *mesh, rest_shape *out) {
    rest_shape copy = *r;
    if (!context_copy_all(mesh->context, list_arrays(&copy, mesh))) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

void rest_shape_free(cscd_context *context, rest_shape *r) {
    context_free(context, r->squared_lengths);
    context_free(context, r->triangle_areas);
    context_free(context, r->vertex_areas);
    context_free(context, r->edge_areas);
    *r = (rest_shape){NULL};
}
