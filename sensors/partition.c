/* The division of a mesh into objects, parts and cells, in which particles walk. */
#include "sensors/partition.h"

#include "sensors/cells.h"
#include "src/mesh/surface.h"

#include <string.h>

static array_list list_arrays(sensor_partition *p) {
    size_t vertices = p->mesh->vertex_count, triangles = p->mesh->triangle_count, parts = p->part_count;
    return (array_list){{ARRAY(p->object_obstacles, p->object_count), ARRAY(p->parts, parts),
                         ARRAY(p->part_generations, parts), ARRAY(p->triangle_parts, triangles),
                         ARRAY(p->vertex_parts, vertices), ARRAY(p->part_vertex_offsets, parts + 1),
                         ARRAY(p->part_vertices, vertices), ARRAY(p->vertex_cells, vertices),
                         ARRAY(p->cell_parts, vertices), ARRAY(p->cell_offsets, vertices + 1),
                         ARRAY(p->cell_vertices, vertices), ARRAY(p->neighbour_offsets, vertices + 1),
                         ARRAY(p->neighbours, 2 * (size_t)p->mesh->edge_count)}};
}

void partition_begin(sensor_partition *partition, cscd_context *context, const cscd_mesh *mesh,
                     const cscd_sensor_options *options) {
    partition->context = context;
    partition->seen = mesh_seen_from(context, mesh);
    partition->mesh = &partition->seen;
    partition->options = options;
    mesh_hold(mesh);
}

void partition_end(sensor_partition *partition) {
    context_free_all(partition->context, list_arrays(partition));
    mesh_release(&partition->seen);
}

static const char *check_cells(const sensor_partition *p) {
    uint32_t vertices = 0;
    for (uint32_t c = 0; c < p->cell_count; c++) {
        if (p->cell_parts[c] >= p->part_count) return "a cell is of a part that there is not";
        if (p->cell_offsets[c] != vertices || p->cell_offsets[c + 1] < vertices)
            return "the cells of a partition do not follow each other";
        vertices = p->cell_offsets[c + 1];
        for (uint32_t i = p->cell_offsets[c]; i < vertices; i++) {
            uint32_t v = p->cell_vertices[i];
            if (v >= p->mesh->vertex_count || p->vertex_cells[v] != c ||
                p->vertex_parts[v] != p->cell_parts[c])
                return "a cell holds a vertex of another one";
        }
    }
    return NULL;
}

const char *partition_validate(const sensor_partition *p) {
    for (uint32_t t = 0; t < p->mesh->triangle_count; t++) {
        if (p->triangle_parts[t] >= p->part_count) return "a triangle is in a part that there is not";
    }
    for (uint32_t v = 0; v < p->mesh->vertex_count; v++) {
        if (p->vertex_cells[v] != PARTITION_NONE && p->vertex_cells[v] >= p->cell_count)
            return "a vertex is in a cell that there is not";
    }
    for (uint32_t i = 0; i < p->part_count; i++) {
        if (p->parts[i].object >= p->object_count) return "a part is of an object that there is not";
    }
    return check_cells(p);
}

/* ---- parts ------------------------------------------------------------------------------------------- */

/* In a scene of one object, its components are the objects of the partition. */
static bool objects_are_components(const cscd_mesh *mesh) {
    return mesh->object_count == 1;
}

static void find_objects(sensor_partition *partition) {
    const cscd_mesh *mesh = partition->mesh;
    for (uint32_t object = 0; object < partition->object_count; object++)
        partition->object_obstacles[object] = objects_are_components(mesh)
                                                  ? component_is_obstacle(mesh, object)
                                                  : mesh->objects[object].obstacle;
}

static void give_triangles(sensor_partition *partition, const cscd_plan *plan) {
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
static uint32_t part_with_most(const sensor_partition *partition, uint32_t vertex, uint32_t *counts) {
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

static void give_vertices(sensor_partition *partition, uint32_t *counts) {
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

static cscd_status make_parts(sensor_partition *partition, const cscd_plan *plan) {
    const cscd_mesh *mesh = partition->mesh;
    partition->object_count = objects_are_components(mesh) ? mesh->component_count : mesh->object_count;
    partition->part_count = plan != NULL ? plan->region_count : mesh->component_count;
    uint32_t *counts = context_allocate(partition->context, partition->part_count, sizeof *counts);
    if (counts == NULL || !context_allocate_all(partition->context, list_arrays(partition))) {
        context_free(partition->context, counts);
        return context_out_of_memory(partition->context);
    }
    find_objects(partition);
    give_triangles(partition, plan);
    give_vertices(partition, counts);
    context_free(partition->context, counts);
    return CSCD_OK;
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

/* Returns the distance of the corners of a triangle, which shares two of them with `plane`, from the plane of
 * that triangle. */
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

/* ---- cells ------------------------------------------------------------------------------------------ */

/* Measures of all parts: the number of cells that one gets depends on the others. */
typedef struct measures {
    double *radii;
    bool *convex, *convex_components;
    uint32_t *counts;
} measures;

static array_list list_measures(const sensor_partition *partition, measures *m) {
    return (array_list){{ARRAY(m->radii, partition->part_count), ARRAY(m->convex, partition->part_count),
                         ARRAY(m->convex_components, partition->mesh->component_count),
                         ARRAY(m->counts, partition->part_count)}};
}

/* A part is convex if it is a whole object that consists of one convex component. */
static void find_convex_parts(const sensor_partition *partition, measures *m) {
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

static cscd_status measure_parts(const sensor_partition *partition, const double *positions, measures *m) {
    if (!context_allocate_all(partition->context, list_measures(partition, m)))
        return context_out_of_memory(partition->context);
    find_radii(partition, positions, m->radii);
    cscd_status status = find_convex_components(partition->mesh, positions, m->convex_components);
    if (status != CSCD_OK) return status;
    find_convex_parts(partition, m);
    return count_cells(partition, m->radii, m->convex, m->counts);
}

static uint32_t most_vertices(const sensor_partition *partition, uint32_t first, uint32_t end) {
    uint32_t most = 0;
    for (uint32_t p = first; p < end; p++) {
        uint32_t count = partition->part_vertex_offsets[p + 1] - partition->part_vertex_offsets[p];
        if (count > most) most = count;
    }
    return most;
}

/* Makes the cells of the parts in [first, end), all or none of them. */
static cscd_status make_cells_of(sensor_partition *partition, const double *positions, uint32_t first,
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

cscd_status partition_divide(sensor_partition *partition, const cscd_plan *plan, const double *positions) {
    cscd_status status = make_parts(partition, plan);
    return status == CSCD_OK ? make_cells_of(partition, positions, 0, partition->part_count) : status;
}

cscd_status partition_renew(sensor_partition *partition, const double *positions, uint32_t part) {
    bool all = part == UINT32_MAX;
    return make_cells_of(partition, positions, all ? 0 : part, all ? partition->part_count : part + 1);
}
