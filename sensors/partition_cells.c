/* The partition of the public API: divides parts into cells, each for one particle of the sensors. */
#include "sensors/cells.h"

#include "src/core/struct_size.h"
#include "src/mesh/positions.h"
#include "src/mesh/surface.h"
#include "src/mesh/views.h"

#include <string.h>

/* ---- parts --------------------------------------------------------------------------------------------- */

/* In a scene of one object, its components are the objects of the partition. */
static bool objects_are_components(const cscd_mesh *mesh) {
    return mesh->object_count == 1;
}

static void find_objects(cscd_partition *partition) {
    const cscd_mesh *mesh = partition->mesh;
    for (uint32_t object = 0; object < partition->object_count; object++)
        partition->object_obstacles[object] = objects_are_components(mesh)
                                                  ? component_is_obstacle(mesh, object)
                                                  : mesh->objects[object].obstacle;
}

static void give_triangles(cscd_partition *partition, const cscd_plan *plan) {
    const cscd_mesh *mesh = partition->mesh;
    const uint32_t *parts = plan != NULL ? plan->triangle_regions : mesh->triangle_components;
    memcpy(partition->triangle_parts, parts, mesh->triangle_count * sizeof *parts);
    uint32_t object = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        while (t >= mesh->objects[object].first_triangle + mesh->objects[object].triangle_count) object++;
        partition->parts[parts[t]].object =
            objects_are_components(mesh) ? mesh->triangle_components[t] : object;
    }
}

/* Returns the part of most triangles around a vertex. counts holds a zero per part, and does so again
 * afterwards. */
static uint32_t part_with_most(const cscd_partition *partition, uint32_t vertex, uint32_t *counts) {
    const cscd_mesh *mesh = partition->mesh;
    uint32_t begin = mesh->vertex_star_offsets[vertex], end = mesh->vertex_star_offsets[vertex + 1];
    uint32_t best = PARTITION_NONE;
    for (uint32_t i = begin; i < end; i++) counts[partition->triangle_parts[mesh->vertex_stars[i]]]++;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t part = partition->triangle_parts[mesh->vertex_stars[i]];
        if (best == PARTITION_NONE || counts[part] > counts[best] ||
            (counts[part] == counts[best] && part < best))
            best = part;
    }
    for (uint32_t i = begin; i < end; i++) counts[partition->triangle_parts[mesh->vertex_stars[i]]] = 0;
    return best;
}

static void give_vertices(cscd_partition *partition, uint32_t *counts) {
    uint32_t vertex_count = partition->mesh->vertex_count, *ends = partition->part_vertex_offsets + 1;
    for (uint32_t v = 0; v < vertex_count; v++)
        partition->vertex_parts[v] = part_with_most(partition, v, counts);
    for (uint32_t v = 0; v < vertex_count; v++) {
        if (partition->vertex_parts[v] != PARTITION_NONE) counts[partition->vertex_parts[v]]++;
    }
    for (uint32_t p = 0, begin = 0; p < partition->part_count; begin += counts[p++]) ends[p] = begin;
    for (uint32_t v = 0; v < vertex_count; v++) {
        uint32_t part = partition->vertex_parts[v];
        if (part != PARTITION_NONE) partition->part_vertices[ends[part]++] = v;
    }
}

/* Returns a partition without cells, or NULL when out of memory. plan is NULL or a plan of the mesh. A vertex
 * belongs to the part with most of its triangles, and of equal ones to that with the smaller number. */
static cscd_partition *partition_of_parts(const cscd_mesh *mesh, const cscd_plan *plan) {
    uint32_t object_count = objects_are_components(mesh) ? mesh->component_count : mesh->object_count;
    uint32_t part_count = plan != NULL ? plan->region_count : mesh->component_count;
    uint32_t *counts = context_allocate(mesh->context, part_count, sizeof *counts);
    if (counts == NULL) return NULL;
    cscd_partition *partition = partition_allocate(mesh, object_count, part_count);
    if (partition != NULL) {
        find_objects(partition);
        give_triangles(partition, plan);
        give_vertices(partition, counts);
    }
    context_free(mesh->context, counts);
    return partition;
}

/* ---- convex components --------------------------------------------------------------------------------- */

static const double concave_tolerance = 1e-6;

/* The largest distance of a vertex from the first one of its component. */
typedef struct extent {
    const double *first;
    double size;
} extent;

static void find_extents(const cscd_mesh *mesh, const double *positions, extent *extents) {
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        extent *e = &extents[mesh->triangle_components[t]];
        if (e->first == NULL) e->first = surface_corner(mesh, positions, t, 0);
        for (uint32_t corner = 0; corner < 3; corner++) {
            const double *p = surface_corner(mesh, positions, t, corner);
            double d[3] = {p[0] - e->first[0], p[1] - e->first[1], p[2] - e->first[2]};
            e->size = fmax(e->size, surface_norm(d));
        }
    }
}

/* How far the corners of a triangle, which shares two of them with `plane`, lie outside the plane of that
 * triangle. */
static double distance_outside(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                               uint32_t plane) {
    double normal[3], farthest = 0.0;
    surface_normal(mesh, positions, plane, normal);
    double norm = surface_norm(normal);
    if (norm == 0.0) return 0.0;
    const double *origin = surface_corner(mesh, positions, plane, 0);
    for (uint32_t corner = 0; corner < 3; corner++) {
        const double *p = surface_corner(mesh, positions, triangle, corner);
        if (triangle_contains(mesh->triangles[plane], mesh->triangles[triangle][corner])) continue;
        double distance = 0.0;
        for (int k = 0; k < 3; k++) distance += (p[k] - origin[k]) * (normal[k] / norm);
        farthest = fmax(farthest, distance);
    }
    return farthest;
}

/* A component is convex when it is closed, manifold, consistently oriented, of Euler characteristic 2, and no
 * edge is concave by more than 1e-6 of the component's size. A triangle without area makes no edge
 * concave. */
static cscd_status find_convex_components(const cscd_mesh *mesh, const double *positions, bool *convex) {
    extent *extents = context_allocate(mesh->context, mesh->component_count, sizeof *extents);
    if (extents == NULL) return context_out_of_memory(mesh->context);
    find_extents(mesh, positions, extents);
    for (uint32_t c = 0; c < mesh->component_count; c++)
        convex[c] = mesh->components[c].closed_manifold && mesh->components[c].euler_characteristic == 2;
    for (uint32_t edge = 0; edge < mesh->edge_count; edge++) {
        const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[edge];
        uint32_t c = mesh->triangle_components[star[0]];
        if (!convex[c]) continue;
        double allowed = concave_tolerance * extents[c].size;
        convex[c] = distance_outside(mesh, positions, star[0], star[1]) <= allowed &&
                    distance_outside(mesh, positions, star[1], star[0]) <= allowed;
    }
    context_free(mesh->context, extents);
    return CSCD_OK;
}

/* ---- the partition ------------------------------------------------------------------------------------- */

static const double normal_weight_max = 1e6;

static const cscd_partition_options default_options = {
    .cells_max = 64, .normal_weight = 1.0, .epsilon = 1e-3};

void cscd_partition_defaults_sized(cscd_partition_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

static cscd_status check_options(cscd_context *context, const cscd_partition_options *options) {
    if (options->cells_max == 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cells_max is 0, expected 1 or more");
    if (!(options->normal_weight >= 0.0 && options->normal_weight <= normal_weight_max))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "normal_weight is %g, expected a number from 0 to %g", options->normal_weight,
                            normal_weight_max);
    if (!(options->epsilon >= 0.0 && options->epsilon < 1.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "epsilon is %g, expected a share of the distortion in [0,1)", options->epsilon);
    return CSCD_OK;
}

/* ---- making cells -------------------------------------------------------------------------------------- */

/* Measures of all parts: the number of cells that one gets depends on the others. */
typedef struct measures {
    double *radii;
    bool *convex, *convex_components;
    uint32_t *counts;
} measures;

static array_list list_measures(const cscd_partition *partition, measures *m) {
    return (array_list){{ARRAY(m->radii, partition->part_count), ARRAY(m->convex, partition->part_count),
                         ARRAY(m->convex_components, partition->mesh->component_count),
                         ARRAY(m->counts, partition->part_count)}};
}

/* A part is convex if it is a whole object that consists of one convex component. */
static void find_convex_parts(const cscd_partition *partition, measures *m) {
    const cscd_mesh *mesh = partition->mesh;
    for (uint32_t p = 0; p < partition->part_count; p++) m->counts[p] = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) m->counts[partition->triangle_parts[t]]++;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t part = partition->triangle_parts[t], c = mesh->triangle_components[t];
        uint32_t whole = mesh->components[c].triangle_count;
        uint32_t object = partition->parts[part].object;
        if (mesh->object_count > 1) whole = mesh->objects[object].triangle_count;
        m->convex[part] = m->convex_components[c] && m->counts[part] == whole;
    }
}

static cscd_status measure_parts(const cscd_partition *partition, const double *positions, measures *m) {
    if (!context_allocate_all(partition->context, list_measures(partition, m)))
        return context_out_of_memory(partition->context);
    find_radii(partition, positions, m->radii);
    cscd_status status = find_convex_components(partition->mesh, positions, m->convex_components);
    if (status != CSCD_OK) return status;
    find_convex_parts(partition, m);
    return count_cells(partition, m->radii, m->convex, m->counts);
}

static uint32_t most_vertices(const cscd_partition *partition, uint32_t first, uint32_t end) {
    uint32_t most = 0;
    for (uint32_t p = first; p < end; p++) {
        uint32_t count = partition->part_vertex_offsets[p + 1] - partition->part_vertex_offsets[p];
        if (count > most) most = count;
    }
    return most;
}

/* Makes the cells of the parts in [first, end), all or none of them. */
static cscd_status make_cells_of(cscd_partition *partition, const double *positions, uint32_t first,
                                 uint32_t end) {
    measures m = {0};
    cell_maker maker;
    cscd_status status = measure_parts(partition, positions, &m);
    if (status == CSCD_OK)
        status = cell_maker_create(partition, positions, most_vertices(partition, first, end), &maker);
    if (status == CSCD_OK) {
        partition->generation++;
        for (uint32_t p = first; p < end; p++) {
            maker.counts[p] = m.counts[p];
            make_cells(&maker, p);
            partition->parts[p].radius = m.radii[p];
            partition->parts[p].convex = m.convex[p];
            partition->part_generations[p] = partition->generation;
        }
        hand_over_cells(&maker);
        cell_maker_free(&maker);
    }
    context_free_all(partition->context, list_measures(partition, &m));
    return status;
}

/* ---- the interface ------------------------------------------------------------------------------------- */

static cscd_status check_plan(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan) {
    if (plan == NULL || plan->mesh_hash == cscd_mesh_hash(mesh)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "the plan was made for another mesh (hash %016llx, this one has %016llx)",
                        (unsigned long long)plan->mesh_hash, (unsigned long long)cscd_mesh_hash(mesh));
}

static const char *validate_listed(const reference_count *object) {
    return partition_validate((const cscd_partition *)object);
}

static cscd_status partition_at(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                                const cscd_partition_options *options, cscd_partition **out) {
    cscd_status status = positions_check(mesh->context, positions, mesh->vertex_count, "positions");
    if (status != CSCD_OK) return status;
    cscd_partition *partition = partition_of_parts(mesh, plan);
    if (partition == NULL) return context_out_of_memory(mesh->context);
    partition->options = *options;
    status = make_cells_of(partition, positions, 0, partition->part_count);
    if (status != CSCD_OK) {
        cscd_partition_destroy(partition);
        return status;
    }
    context_list_object(partition->context, &partition->references, validate_listed);
    *out = partition;
    return CSCD_OK;
}

static cscd_status create_partition(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                    const cscd_view *positions, const cscd_partition_options *options,
                                    cscd_partition **out) {
    const cscd_mesh seen = mesh_seen_from(context, mesh);
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_partition_create: out is NULL");
    cscd_partition_options chosen = default_options;
    double *buffer = NULL;
    const double *x = NULL;
    cscd_status status = CSCD_OK;
    if (options != NULL)
        status = struct_take_options(context, &chosen, sizeof chosen, LEAST_SIZE(cscd_partition_options),
                                     options, "cscd_partition_defaults");
    if (status == CSCD_OK) status = check_options(context, &chosen);
    if (status == CSCD_OK && mesh_has_loose_objects(mesh))
        status =
            context_fail(context, CSCD_INVALID_MESH,
                         "a partition is of triangles alone, but the mesh has wires, points or half-spaces");
    if (status == CSCD_OK) status = check_plan(context, mesh, plan);
    if (status == CSCD_OK) status = views_read(context, mesh, positions, "positions", &buffer, &x);
    if (status == CSCD_OK) status = partition_at(&seen, plan, x, &chosen, out);
    context_free(context, buffer);
    return status;
}

cscd_status cscd_partition_create(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                  const cscd_view *positions, const cscd_partition_options *options,
                                  cscd_partition **out) {
    if (context == NULL || mesh == NULL) return context_lacks(context, "cscd_partition_create", "mesh");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, create_partition(context, mesh, plan, positions, options, out));
}

static cscd_status renew_at(cscd_partition *partition, const double *positions, uint32_t part) {
    cscd_status status =
        positions_check(partition->context, positions, partition->mesh->vertex_count, "positions");
    if (status != CSCD_OK) return status;
    bool all = part == UINT32_MAX;
    return make_cells_of(partition, positions, all ? 0 : part, all ? partition->part_count : part + 1);
}

static cscd_status renew_partition(cscd_partition *partition, const cscd_view *positions, uint32_t part) {
    cscd_context *context = partition->context;
    if (part != UINT32_MAX && part >= partition->part_count)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "part is %u, but there are %u: expected one of them, or UINT32_MAX for all", part,
                            partition->part_count);
    double *buffer = NULL;
    const double *x = NULL;
    cscd_status status = views_read(context, partition->mesh, positions, "positions", &buffer, &x);
    if (status == CSCD_OK) status = renew_at(partition, x, part);
    context_free(context, buffer);
    return status;
}

cscd_status cscd_partition_renew(cscd_partition *partition, const cscd_view *positions, uint32_t part) {
    if (partition == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(partition, &entry)) return entry.status;
    return context_leave(&entry, renew_partition(partition, positions, part));
}
