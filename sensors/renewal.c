/* Areas, edges and concavity of parts, measured when their cells are made and again after each step. */
#include "sensors/renewal.h"

#include "src/core/vec3.h"

/* Edges that fold inwards by less than a degree count as flat: rounding and noise bend flat surfaces to and
 * fro. */
#define SINE_OF_FLAT 0.017452406437283512
/* A part turns concave when the share of its concave edges grows by more than this. */
#define CONCAVE_GROWTH 0.1
/* The number of vertices of a cell from which its area is first estimated, at most. */
enum { ESTIMATES_OF_CELL = 64 };

static array_list list_arrays(sensor_renewal *r) {
    size_t parts = r->part_count;
    return (array_list){
        {ARRAY(r->part_generations, parts), ARRAY(r->first, parts), ARRAY(r->now, parts),
         ARRAY(r->inner, parts), ARRAY(r->concave, parts), ARRAY(r->cell_areas, r->mesh->vertex_count),
         ARRAY(r->facings, r->mesh->triangle_count), ARRAY(r->volumes, r->mesh->component_count),
         ARRAY(r->inside_out, r->mesh->component_count)}};
}

cscd_status sensor_renewal_create(const sensor_partition *partition, sensor_renewal *out) {
    sensor_renewal renewal = {.mesh = partition->mesh, .part_count = partition->part_count};
    cscd_context *context = partition->mesh->context;
    if (!context_allocate_all(context, list_arrays(&renewal))) return context_out_of_memory(context);
    *out = renewal;
    return CSCD_OK;
}

void sensor_renewal_destroy(sensor_renewal *renewal) {
    if (renewal->mesh == NULL) return;
    context_free_all(renewal->mesh->context, list_arrays(renewal));
    *renewal = (sensor_renewal){0};
}

/* ---- walks: the estimate of an area -------------------------------------------------------------------- */

/* A straight walk over the vertices of a cell. */
typedef struct walk {
    const sensor_partition *partition;
    const double *positions;
    uint32_t from, cell;
    double direction[3];
} walk;

static const double *position_of(const double *positions, uint32_t vertex) {
    return positions + (size_t)vertex * 3;
}

/* Returns how far along the walk a vertex lies. */
static double progress_at(const walk *w, uint32_t vertex) {
    double offset[3];
    vec3_subtract(position_of(w->positions, vertex), position_of(w->positions, w->from), offset);
    return vec3_dot(offset, w->direction);
}

/* Returns the neighbour of `at`, in the cell or not, at the smallest angle to the direction (3.19-3.21),
 * among those that lie farther along the walk, or `at` if none does. Angles are compared by the squares of
 * their cosines, which are positive, multiplied out. */
static uint32_t next_vertex(const walk *w, uint32_t at) {
    const cscd_mesh *mesh = w->partition->mesh;
    double here = progress_at(w, at), best_along = 0.0, best_squared = 1.0;
    uint32_t next = at;
    for (uint32_t s = mesh->vertex_star_offsets[at]; s < mesh->vertex_star_offsets[at + 1]; s++) {
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = mesh->triangles[mesh->vertex_stars[s]][k];
            double offset[3];
            vec3_subtract(position_of(w->positions, vertex), position_of(w->positions, at), offset);
            double along = vec3_dot(offset, w->direction), squared = vec3_dot(offset, offset);
            if (!(along > 0.0 && along * along * best_squared > best_along * best_along * squared)) continue;
            if (!(progress_at(w, vertex) > here)) continue;
            best_along = along;
            best_squared = squared;
            next = vertex;
        }
    }
    return next;
}

/* Returns the length of the path that leaves the cell, the last edge included (3.22). Every step leads
 * farther along the walk, as computed, so no vertex comes twice and the walk ends on any mesh. In a cell that
 * has no outside it only goes to the far end of the surface. */
static double walk_out(const walk *w) {
    double total = 0.0;
    uint32_t at = w->from;
    while (w->partition->vertex_cells[at] == w->cell) {
        uint32_t next = next_vertex(w, at);
        if (next == at) break;
        double offset[3];
        vec3_subtract(position_of(w->positions, next), position_of(w->positions, at), offset);
        total += sqrt(vec3_dot(offset, offset));
        at = next;
    }
    return total;
}

/* Scales a vector to length 1; returns false for one that has no direction. */
static bool scale_to_unit(double v[3]) {
    double size = vec3_largest(v);
    if (!(size > 0.0) || !isfinite(size)) return false;
    for (int k = 0; k < 3; k++) v[k] /= size;
    double length = sqrt(vec3_dot(v, v));
    for (int k = 0; k < 3; k++) v[k] /= length;
    return true;
}

/* The unit normal at a vertex: the sum of its triangles' area vectors. */
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
    return scale_to_unit(out);
}

/* The tangent x follows the first edge, so that the axes move with the body. Returns false for a vertex that
 * has no axes. */
static bool axes_at(const cscd_mesh *mesh, const double *positions, uint32_t vertex, double x[3],
                    double y[3]) {
    double normal[3], edge[3];
    if (!normal_at(mesh, positions, vertex, normal)) return false;
    const uint32_t *corners = mesh->triangles[mesh->vertex_stars[mesh->vertex_star_offsets[vertex]]];
    for (int k = 0; k < 3; k++) {
        vec3_subtract(position_of(positions, corners[k]), position_of(positions, vertex), edge);
        vec3_add_scaled(edge, -vec3_dot(edge, normal), normal, x);
        if (!scale_to_unit(x)) continue;
        vec3_cross(normal, x, y);
        return true;
    }
    return false;
}

double sensor_renewal_estimate(const sensor_partition *partition, const double *positions, uint32_t vertex) {
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

static void measure_triangles(sensor_renewal *renewal, const sensor_partition *partition,
                              const double *positions) {
    const cscd_mesh *mesh = renewal->mesh;
    for (uint32_t c = 0; c < partition->cell_count; c++) renewal->cell_areas[c] = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->triangles[t];
        double side_a[3], side_b[3];
        facing *f = &renewal->facings[t];
        const double *p = position_of(positions, corners[0]);
        vec3_subtract(position_of(positions, corners[1]), p, side_a);
        vec3_subtract(position_of(positions, corners[2]), p, side_b);
        vec3_cross(side_a, side_b, f->normal);
        f->length = sqrt(vec3_dot(f->normal, f->normal));
        for (int k = 0; k < 3; k++)
            renewal->cell_areas[partition->vertex_cells[corners[k]]] += f->length / 6.0;
    }
}

/* A closed surface whose triangles face inwards encloses a negative volume. */
static void find_inside_out(sensor_renewal *renewal, const double *positions) {
    const cscd_mesh *mesh = renewal->mesh;
    double *volumes = renewal->volumes;
    for (uint32_t c = 0; c < mesh->component_count; c++) volumes[c] = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        double from_origin[3];
        vec3_subtract(position_of(positions, mesh->triangles[t][0]), positions, from_origin);
        volumes[mesh->triangle_components[t]] += vec3_dot(from_origin, renewal->facings[t].normal);
    }
    for (uint32_t c = 0; c < mesh->component_count; c++)
        renewal->inside_out[c] = mesh->components[c].closed_manifold && volumes[c] < 0.0;
}

static uint32_t corner_opposite(const uint32_t triangle[3], const uint32_t edge[2]) {
    for (int k = 0; k < 2; k++) {
        if (triangle[k] != edge[0] && triangle[k] != edge[1]) return triangle[k];
    }
    return triangle[2];
}

/* Does the triangle run along the edge in the direction in which the edge is stored? */
static bool goes_along(const uint32_t triangle[3], const uint32_t edge[2]) {
    for (int k = 0; k < 3; k++) {
        if (triangle[k] == edge[0]) return triangle[(k + 1) % 3] == edge[1];
    }
    return false;
}

/* The sine of the fold is the height of the far corner over the other triangle's plane, divided by its
 * distance from the edge. */
static bool edge_is_concave(const sensor_renewal *renewal, const double *positions, uint32_t edge,
                            double length) {
    const cscd_mesh *mesh = renewal->mesh;
    const uint32_t *ends = mesh->edges[edge], *star = mesh->edge_stars + mesh->edge_star_offsets[edge];
    const uint32_t *one = mesh->triangles[star[0]], *other = mesh->triangles[star[1]];
    if (goes_along(one, ends) == goes_along(other, ends)) return false;
    const facing *f = &renewal->facings[star[0]];
    double to_corner[3];
    vec3_subtract(position_of(positions, corner_opposite(other, ends)), position_of(positions, ends[0]),
                  to_corner);
    double height = vec3_dot(to_corner, f->normal);
    if (renewal->inside_out[mesh->triangle_components[star[0]]]) height = -height;
    return height * length > SINE_OF_FLAT * f->length * renewal->facings[star[1]].length;
}

static bool edge_is_inner(const cscd_mesh *mesh, const sensor_partition *partition, uint32_t edge) {
    const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[edge];
    return edge_star_size(mesh, edge) == 2 &&
           partition->triangle_parts[star[0]] == partition->triangle_parts[star[1]];
}

static void measure_edges(sensor_renewal *renewal, const sensor_partition *partition,
                          const double *positions) {
    const cscd_mesh *mesh = renewal->mesh;
    for (uint32_t p = 0; p < partition->part_count; p++) renewal->inner[p] = renewal->concave[p] = 0.0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *ends = mesh->edges[e];
        double offset[3];
        vec3_subtract(position_of(positions, ends[1]), position_of(positions, ends[0]), offset);
        double squared = vec3_dot(offset, offset), length = sqrt(squared);
        for (int k = 0; k < 2; k++) {
            part_measures *now = &renewal->now[partition->vertex_parts[ends[k]]];
            now->edge_squared = max_of(now->edge_squared, squared);
        }
        if (!edge_is_inner(mesh, partition, e)) continue;
        uint32_t part = partition->triangle_parts[mesh->edge_stars[mesh->edge_star_offsets[e]]];
        renewal->inner[part] += length;
        if (edge_is_concave(renewal, positions, e, length)) renewal->concave[part] += length;
    }
    for (uint32_t p = 0; p < partition->part_count; p++)
        renewal->now[p].concave = renewal->inner[p] > 0.0 ? renewal->concave[p] / renewal->inner[p] : 0.0;
}

/* Measures everything except the estimates of areas. */
static void measure_parts(sensor_renewal *renewal, const sensor_partition *partition,
                          const double *positions) {
    for (uint32_t p = 0; p < partition->part_count; p++) renewal->now[p] = (part_measures){0};
    measure_triangles(renewal, partition, positions);
    for (uint32_t c = 0; c < partition->cell_count; c++) {
        part_measures *now = &renewal->now[partition->cell_parts[c]];
        now->area = max_of(now->area, renewal->cell_areas[c]);
    }
    measure_edges(renewal, partition, positions);
}

/* ---- the check ----------------------------------------------------------------------------------------- */

/* Estimates from up to ESTIMATES_OF_CELL vertices that are spread over the cell. */
static double largest_estimate(const sensor_partition *partition, const double *positions, uint32_t cell) {
    uint32_t begin = partition->cell_offsets[cell], end = partition->cell_offsets[cell + 1];
    uint32_t stride = (end - begin + ESTIMATES_OF_CELL - 1) / ESTIMATES_OF_CELL;
    double largest = 0.0;
    for (uint32_t i = begin; i < end; i += stride)
        largest = max_of(largest, sensor_renewal_estimate(partition, positions, partition->cell_vertices[i]));
    return largest;
}

static void take_measure(sensor_renewal *renewal, const sensor_partition *partition, const double *positions,
                         uint32_t part) {
    const cscd_sensor_part *cells = &partition->parts[part];
    part_measures *first = &renewal->first[part];
    *first = renewal->now[part];
    for (uint32_t i = 0; i < cells->cell_count; i++)
        first->estimate =
            max_of(first->estimate, largest_estimate(partition, positions, cells->first_cell + i));
}

void sensor_renewal_follow(sensor_renewal *renewal, const sensor_partition *partition,
                           const double *positions) {
    if (renewal->generation == partition->generation) return;
    measure_triangles(renewal, partition, positions);
    find_inside_out(renewal, positions);
    measure_parts(renewal, partition, positions);
    for (uint32_t p = 0; p < partition->part_count; p++) {
        if (renewal->part_generations[p] == partition->part_generations[p]) continue;
        renewal->part_generations[p] = partition->part_generations[p];
        take_measure(renewal, partition, positions, p);
    }
    renewal->generation = partition->generation;
}

/* A long edge comes last: new cells do not mend it, so it must not hide what they would mend. */
static cscd_renewal reason_of(const part_measures *first, const part_measures *now,
                              const renewal_limits *limits) {
    double edge = limits->edge_length;
    if (now->area > limits->area_factor * first->area) return CSCD_RENEWAL_AREA;
    if (now->estimate > limits->area_factor * first->estimate) return CSCD_RENEWAL_AREA;
    if (now->concave > first->concave + CONCAVE_GROWTH) return CSCD_RENEWAL_CONCAVE;
    return edge > 0.0 && now->edge_squared > edge * edge ? CSCD_RENEWAL_EDGE : CSCD_RENEWAL_NONE;
}

uint32_t sensor_renewal_check(sensor_renewal *renewal, const sensor_partition *partition,
                              const double *positions, const uint32_t *particles,
                              const renewal_limits *limits, cscd_renewal *renewals) {
    uint32_t due = 0;
    measure_parts(renewal, partition, positions);
    for (uint32_t c = 0; particles != NULL && c < partition->cell_count; c++) {
        part_measures *now = &renewal->now[partition->cell_parts[c]];
        now->estimate = max_of(now->estimate, sensor_renewal_estimate(partition, positions, particles[c]));
    }
    for (uint32_t p = 0; p < partition->part_count; p++) {
        renewals[p] = reason_of(&renewal->first[p], &renewal->now[p], limits);
        due += renewals[p] != CSCD_RENEWAL_NONE;
    }
    return due;
}
