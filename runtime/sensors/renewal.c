/* Areas, edges and concavity of parts, measured when their cells are made and again after each step. */
#include "runtime/sensors/renewal.h"

#include "src/core/vec3.h"

/* Edges that fold inwards by less than a degree are flat: rounding and noise bend what is flat to and fro. */
#define SINE_OF_FLAT 0.017452406437283512
/* A part turns concave when the share of its concave edges grows by more than this. */
#define CONCAVE_GROWTH 0.1
/* Vertices of a cell from which its area is estimated at first. */
enum { ESTIMATES_OF_CELL = 64 };

cscd_status sensor_upkeep_create(const cscd_partition *partition, sensor_upkeep *out) {
    const cscd_mesh *mesh = partition->mesh;
    cscd_context *context = mesh->context;
    uint32_t parts = partition->part_count;
    sensor_upkeep upkeep = {
        .mesh = mesh,
        .part_generations = context_allocate(context, parts, sizeof(uint64_t)),
        .first = context_allocate(context, parts, sizeof(part_measures)),
        .now = context_allocate(context, parts, sizeof(part_measures)),
        .inner = context_allocate(context, parts, sizeof(double)),
        .concave = context_allocate(context, parts, sizeof(double)),
        .cell_areas = context_allocate(context, mesh->vertex_count, sizeof(double)),
        .facings = context_allocate(context, mesh->triangle_count, sizeof(facing)),
        .inside_out = context_allocate(context, mesh->component_count, sizeof(bool)),
    };
    if (upkeep.part_generations == NULL || upkeep.first == NULL || upkeep.now == NULL ||
        upkeep.inner == NULL || upkeep.concave == NULL || upkeep.cell_areas == NULL ||
        upkeep.facings == NULL || upkeep.inside_out == NULL) {
        sensor_upkeep_destroy(&upkeep);
        return context_out_of_memory(context);
    }
    *out = upkeep;
    return CSCD_OK;
}

void sensor_upkeep_destroy(sensor_upkeep *upkeep) {
    if (upkeep->mesh == NULL) return;
    cscd_context *context = upkeep->mesh->context;
    context_free(context, upkeep->part_generations);
    context_free(context, upkeep->first);
    context_free(context, upkeep->now);
    context_free(context, upkeep->inner);
    context_free(context, upkeep->concave);
    context_free(context, upkeep->cell_areas);
    context_free(context, upkeep->facings);
    context_free(context, upkeep->inside_out);
    *upkeep = (sensor_upkeep){0};
}

/* ---- walks: the estimate of an area -------------------------------------------------------------------- */

/* What a walk is about. */
typedef struct walk {
    const cscd_partition *partition;
    const double *positions;
    uint32_t from, cell;
    double direction[3];
} walk;

static const double *position_of(const double *positions, uint32_t vertex) {
    return positions + (size_t)vertex * 3;
}

/* How far a vertex lies along the walk. */
static double progress_at(const walk *w, uint32_t vertex) {
    double way[3];
    vec3_subtract(position_of(w->positions, vertex), position_of(w->positions, w->from), way);
    return vec3_dot(way, w->direction);
}

/* The neighbour of `at`, in the cell or not, at the smallest angle to the direction (3.19-3.21), of those
 * that lie farther along; `at` where none does. Angles are compared by squares of their cosines, which are
 * positive, multiplied out. */
static uint32_t next_vertex(const walk *w, uint32_t at) {
    const cscd_mesh *mesh = w->partition->mesh;
    double here = progress_at(w, at), best_along = 0.0, best_squared = 1.0;
    uint32_t next = at;
    for (uint32_t s = mesh->vertex_star_offsets[at]; s < mesh->vertex_star_offsets[at + 1]; s++) {
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = mesh->triangles[mesh->vertex_stars[s]][k];
            double way[3];
            vec3_subtract(position_of(w->positions, vertex), position_of(w->positions, at), way);
            double along = vec3_dot(way, w->direction), squared = vec3_dot(way, way);
            if (!(along > 0.0 && along * along * best_squared > best_along * best_along * squared)) continue;
            if (!(progress_at(w, vertex) > here)) continue;
            best_along = along;
            best_squared = squared;
            next = vertex;
        }
    }
    return next;
}

/* The length of the way out of the cell, the last edge included (3.22). Every step leads farther along, as
 * computed, so no vertex comes twice and the walk ends on any mesh: also in a cell without an outside, where
 * it goes to the far end of the surface only. */
static double walk_out(const walk *w) {
    double total = 0.0;
    uint32_t at = w->from;
    while (w->partition->vertex_cells[at] == w->cell) {
        uint32_t next = next_vertex(w, at);
        if (next == at) break;
        double way[3];
        vec3_subtract(position_of(w->positions, next), position_of(w->positions, at), way);
        total += sqrt(vec3_dot(way, way));
        at = next;
    }
    return total;
}

/* Scales to length 1; false where there is none. */
static bool normalise(double v[3]) {
    double size = vec3_largest(v);
    if (!(size > 0.0) || !isfinite(size)) return false;
    for (int k = 0; k < 3; k++) v[k] /= size;
    double length = sqrt(vec3_dot(v, v));
    for (int k = 0; k < 3; k++) v[k] /= length;
    return true;
}

/* The normal at a vertex: that of its triangles' areas. */
static bool normal_at(const cscd_mesh *mesh, const double *positions, uint32_t vertex, double out[3]) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t s = mesh->vertex_star_offsets[vertex]; s < mesh->vertex_star_offsets[vertex + 1]; s++) {
        const uint32_t *corners = mesh->triangles[mesh->vertex_stars[s]];
        double side_a[3], side_b[3], cross[3];
        const double *p = position_of(positions, corners[0]);
        vec3_subtract(position_of(positions, corners[1]), p, side_a);
        vec3_subtract(position_of(positions, corners[2]), p, side_b);
        vec3_cross(side_a, side_b, cross);
        for (int k = 0; k < 3; k++) sum[k] += cross[k];
    }
    memcpy(out, sum, sizeof sum);
    return normalise(out);
}

/* The tangent X is the first edge's, so that axes move with the body; false where a vertex has none. */
static bool axes_at(const cscd_mesh *mesh, const double *positions, uint32_t vertex, double x[3],
                    double y[3]) {
    double normal[3], edge[3];
    if (!normal_at(mesh, positions, vertex, normal)) return false;
    const uint32_t *corners = mesh->triangles[mesh->vertex_stars[mesh->vertex_star_offsets[vertex]]];
    for (int k = 0; k < 3; k++) {
        vec3_subtract(position_of(positions, corners[k]), position_of(positions, vertex), edge);
        vec3_add_scaled(edge, -vec3_dot(edge, normal), normal, x);
        if (!normalise(x)) continue;
        vec3_cross(normal, x, y);
        return true;
    }
    return false;
}

double sensor_upkeep_estimate(const cscd_partition *partition, const double *positions, uint32_t vertex) {
    double axes[2][3], sides[2] = {0.0, 0.0};
    uint32_t cell = partition->vertex_cells[vertex];
    if (cell == PARTITION_NONE || !axes_at(partition->mesh, positions, vertex, axes[0], axes[1])) return 0.0;
    for (int i = 0; i < 4; i++) {
        walk w = {partition, positions, vertex, cell, {0.0, 0.0, 0.0}};
        for (int k = 0; k < 3; k++) w.direction[k] = i % 2 == 0 ? axes[i / 2][k] : -axes[i / 2][k];
        sides[i / 2] += walk_out(&w);
    }
    return sides[0] * sides[1];
}

/* ---- measures ------------------------------------------------------------------------------------------ */

static void measure_triangles(sensor_upkeep *upkeep, const cscd_partition *partition,
                              const double *positions) {
    const cscd_mesh *mesh = upkeep->mesh;
    for (uint32_t c = 0; c < partition->cell_count; c++) upkeep->cell_areas[c] = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->triangles[t];
        double side_a[3], side_b[3];
        facing *f = &upkeep->facings[t];
        const double *p = position_of(positions, corners[0]);
        vec3_subtract(position_of(positions, corners[1]), p, side_a);
        vec3_subtract(position_of(positions, corners[2]), p, side_b);
        vec3_cross(side_a, side_b, f->normal);
        f->length = sqrt(vec3_dot(f->normal, f->normal));
        for (int k = 0; k < 3; k++)
            upkeep->cell_areas[partition->vertex_cells[corners[k]]] += f->length / 6.0;
    }
}

/* A closed surface whose triangles face inwards encloses a negative volume. */
static void find_inside_out(sensor_upkeep *upkeep, const double *positions) {
    const cscd_mesh *mesh = upkeep->mesh;
    double *volumes = upkeep->cell_areas; /* free between measures; a component has at least three vertices */
    for (uint32_t c = 0; c < mesh->component_count; c++) volumes[c] = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        double from_origin[3];
        vec3_subtract(position_of(positions, mesh->triangles[t][0]), positions, from_origin);
        volumes[mesh->triangle_components[t]] += vec3_dot(from_origin, upkeep->facings[t].normal);
    }
    for (uint32_t c = 0; c < mesh->component_count; c++)
        upkeep->inside_out[c] = mesh->components[c].closed_manifold && volumes[c] < 0.0;
}

static uint32_t corner_opposite(const uint32_t triangle[3], const uint32_t edge[2]) {
    for (int k = 0; k < 2; k++) {
        if (triangle[k] != edge[0] && triangle[k] != edge[1]) return triangle[k];
    }
    return triangle[2];
}

/* Does the triangle go along the edge as the edge is stored? */
static bool goes_along(const uint32_t triangle[3], const uint32_t edge[2]) {
    for (int k = 0; k < 3; k++) {
        if (triangle[k] == edge[0]) return triangle[(k + 1) % 3] == edge[1];
    }
    return false;
}

/* The sine of the fold is the far corner's height over the one triangle's plane by its distance from the
 * edge. */
static bool edge_is_concave(const sensor_upkeep *upkeep, const double *positions, uint32_t edge,
                            double length) {
    const cscd_mesh *mesh = upkeep->mesh;
    const uint32_t *ends = mesh->edges[edge], *star = mesh->edge_stars + mesh->edge_star_offsets[edge];
    const uint32_t *one = mesh->triangles[star[0]], *other = mesh->triangles[star[1]];
    if (goes_along(one, ends) == goes_along(other, ends)) return false;
    const facing *f = &upkeep->facings[star[0]];
    double to_corner[3];
    vec3_subtract(position_of(positions, corner_opposite(other, ends)), position_of(positions, ends[0]),
                  to_corner);
    double height = vec3_dot(to_corner, f->normal);
    if (upkeep->inside_out[mesh->triangle_components[star[0]]]) height = -height;
    return height * length > SINE_OF_FLAT * f->length * upkeep->facings[star[1]].length;
}

static bool edge_is_inner(const cscd_mesh *mesh, const cscd_partition *partition, uint32_t edge) {
    const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[edge];
    return edge_star_size(mesh, edge) == 2 &&
           partition->triangle_parts[star[0]] == partition->triangle_parts[star[1]];
}

static void measure_edges(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions) {
    const cscd_mesh *mesh = upkeep->mesh;
    for (uint32_t p = 0; p < partition->part_count; p++) upkeep->inner[p] = upkeep->concave[p] = 0.0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *ends = mesh->edges[e];
        double way[3];
        vec3_subtract(position_of(positions, ends[1]), position_of(positions, ends[0]), way);
        double squared = vec3_dot(way, way), length = sqrt(squared);
        for (int k = 0; k < 2; k++) {
            part_measures *now = &upkeep->now[partition->vertex_parts[ends[k]]];
            now->edge_squared = max_of(now->edge_squared, squared);
        }
        if (!edge_is_inner(mesh, partition, e)) continue;
        uint32_t part = partition->triangle_parts[mesh->edge_stars[mesh->edge_star_offsets[e]]];
        upkeep->inner[part] += length;
        if (edge_is_concave(upkeep, positions, e, length)) upkeep->concave[part] += length;
    }
    for (uint32_t p = 0; p < partition->part_count; p++)
        upkeep->now[p].concave = upkeep->inner[p] > 0.0 ? upkeep->concave[p] / upkeep->inner[p] : 0.0;
}

/* All but the estimates. */
static void measure(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions) {
    for (uint32_t p = 0; p < partition->part_count; p++) upkeep->now[p] = (part_measures){0};
    measure_triangles(upkeep, partition, positions);
    for (uint32_t c = 0; c < partition->cell_count; c++) {
        part_measures *now = &upkeep->now[partition->cell_parts[c]];
        now->area = max_of(now->area, upkeep->cell_areas[c]);
    }
    measure_edges(upkeep, partition, positions);
}

/* ---- the check ----------------------------------------------------------------------------------------- */

/* Of vertices spread over the cell: all of a small one. */
static double largest_estimate(const cscd_partition *partition, const double *positions, uint32_t cell) {
    uint32_t begin = partition->cell_offsets[cell], end = partition->cell_offsets[cell + 1];
    uint32_t stride = (end - begin + ESTIMATES_OF_CELL - 1) / ESTIMATES_OF_CELL;
    double largest = 0.0;
    for (uint32_t i = begin; i < end; i += stride)
        largest = max_of(largest, sensor_upkeep_estimate(partition, positions, partition->cell_vertices[i]));
    return largest;
}

static void take_measure(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions,
                         uint32_t part) {
    const cscd_part *cells = &partition->parts[part];
    part_measures *first = &upkeep->first[part];
    *first = upkeep->now[part];
    for (uint32_t i = 0; i < cells->cell_count; i++)
        first->estimate =
            max_of(first->estimate, largest_estimate(partition, positions, cells->first_cell + i));
}

void sensor_upkeep_follow(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions) {
    if (upkeep->generation == partition->generation) return;
    measure_triangles(upkeep, partition, positions);
    find_inside_out(upkeep, positions);
    measure(upkeep, partition, positions);
    for (uint32_t p = 0; p < partition->part_count; p++) {
        if (upkeep->part_generations[p] == partition->part_generations[p]) continue;
        upkeep->part_generations[p] = partition->part_generations[p];
        take_measure(upkeep, partition, positions, p);
    }
    upkeep->generation = partition->generation;
}

/* A long edge comes last: it stays after new cells, and must not hide what these would mend. */
static cscd_renewal reason_of(const part_measures *first, const part_measures *now,
                              const upkeep_limits *limits) {
    double edge = limits->edge_length;
    if (now->area > limits->area_factor * first->area) return CSCD_RENEWAL_AREA;
    if (now->estimate > limits->area_factor * first->estimate) return CSCD_RENEWAL_AREA;
    if (now->concave > first->concave + CONCAVE_GROWTH) return CSCD_RENEWAL_CONCAVE;
    return edge > 0.0 && now->edge_squared > edge * edge ? CSCD_RENEWAL_EDGE : CSCD_RENEWAL_NONE;
}

uint32_t sensor_upkeep_check(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions,
                             const uint32_t *particles, const upkeep_limits *limits, cscd_renewal *renewals) {
    uint32_t due = 0;
    measure(upkeep, partition, positions);
    for (uint32_t c = 0; particles != NULL && c < partition->cell_count; c++) {
        part_measures *now = &upkeep->now[partition->cell_parts[c]];
        now->estimate = max_of(now->estimate, sensor_upkeep_estimate(partition, positions, particles[c]));
    }
    for (uint32_t p = 0; p < partition->part_count; p++) {
        renewals[p] = reason_of(&upkeep->first[p], &upkeep->now[p], limits);
        due += renewals[p] != CSCD_RENEWAL_NONE;
    }
    return due;
}
