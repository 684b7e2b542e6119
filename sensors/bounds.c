/* Moving balls about vertices that hold the cells' triangles, and whether those of two parts stay apart. */
#include "sensors/bounds.h"

#include "src/core/vec3.h"

#include <assert.h>
#include <float.h>

static array_list list_arrays(sensor_bounds *b) {
    size_t vertices = b->mesh->vertex_count, triangles = b->mesh->triangle_count, parts = b->part_count;
    return (array_list){{ARRAY(b->offsets, vertices + 1), ARRAY(b->corners, 3 * triangles),
                         ARRAY(b->homes, triangles), ARRAY(b->last, vertices), ARRAY(b->cursor, vertices),
                         ARRAY(b->middles, vertices), ARRAY(b->unbounded, parts), ARRAY(b->balls, vertices),
                         ARRAY(b->boxes, parts)}};
}

cscd_status sensor_bounds_create(const cscd_partition *partition, sensor_bounds *out) {
    sensor_bounds bounds = {.mesh = partition->mesh, .part_count = partition->part_count};
    cscd_context *context = partition->mesh->context;
    if (!context_allocate_all(context, list_arrays(&bounds))) return context_out_of_memory(context);
    *out = bounds;
    return CSCD_OK;
}

void sensor_bounds_destroy(sensor_bounds *bounds) {
    if (bounds->mesh == NULL) return;
    context_free_all(bounds->mesh->context, list_arrays(bounds));
    *bounds = (sensor_bounds){0};
}

/* ---- the cell whose ball holds a triangle -------------------------------------------------------------- */

/* Returns the cell of the first corner that belongs to the triangle's own part. */
static uint32_t home_by_corner(const cscd_partition *partition, uint32_t triangle) {
    for (int k = 0; k < 3; k++) {
        uint32_t vertex = partition->mesh->triangles[triangle][k];
        if (partition->vertex_parts[vertex] == partition->triangle_parts[triangle])
            return partition->vertex_cells[vertex];
    }
    return PARTITION_NONE;
}

/* Chooses the cell of a triangle whose corners all belong to other parts: that of a neighbour across an edge,
 * or else any cell of its part. Either is right; the first makes a smaller ball. */
static uint32_t home_by_neighbour(const sensor_bounds *bounds, const cscd_partition *partition,
                                  uint32_t triangle) {
    const cscd_mesh *mesh = bounds->mesh;
    uint32_t part = partition->triangle_parts[triangle];
    for (int k = 0; k < 3; k++) {
        uint32_t edge = mesh->triangle_edges[triangle][k];
        for (uint32_t s = mesh->edge_star_offsets[edge]; s < mesh->edge_star_offsets[edge + 1]; s++) {
            uint32_t other = mesh->edge_stars[s], home = bounds->homes[other];
            if (partition->triangle_parts[other] == part && home != PARTITION_NONE) return home;
        }
    }
    return partition->parts[part].cell_count > 0 ? partition->parts[part].first_cell : PARTITION_NONE;
}

static void find_homes(sensor_bounds *bounds, const cscd_partition *partition) {
    uint32_t triangles = bounds->mesh->triangle_count;
    memset(bounds->unbounded, 0, partition->part_count * sizeof *bounds->unbounded);
    for (uint32_t t = 0; t < triangles; t++) bounds->homes[t] = home_by_corner(partition, t);
    for (uint32_t t = 0; t < triangles; t++) {
        if (bounds->homes[t] == PARTITION_NONE) bounds->homes[t] = home_by_neighbour(bounds, partition, t);
        if (bounds->homes[t] == PARTITION_NONE) bounds->unbounded[partition->triangle_parts[t]] = true;
    }
}

/* Lists the corners of the triangles cell by cell. */
static void list_corners(sensor_bounds *bounds, uint32_t cell_count) {
    const cscd_mesh *mesh = bounds->mesh;
    memset(bounds->offsets, 0, ((size_t)cell_count + 1) * sizeof *bounds->offsets);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (bounds->homes[t] != PARTITION_NONE) bounds->offsets[bounds->homes[t] + 1] += 3;
    }
    for (uint32_t c = 0; c < cell_count; c++) {
        bounds->cursor[c] = bounds->offsets[c];
        bounds->offsets[c + 1] += bounds->offsets[c];
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t home = bounds->homes[t];
        if (home == PARTITION_NONE) continue;
        memcpy(bounds->corners + bounds->cursor[home], mesh->triangles[t], sizeof mesh->triangles[t]);
        bounds->cursor[home] += 3;
    }
}

/* Leaves each vertex only once in the list of a cell. */
static void drop_repeated(sensor_bounds *bounds, uint32_t cell_count) {
    uint32_t kept = 0, begin = 0;
    for (uint32_t v = 0; v < bounds->mesh->vertex_count; v++) bounds->last[v] = PARTITION_NONE;
    for (uint32_t c = 0; c < cell_count; c++) {
        uint32_t end = bounds->offsets[c + 1];
        bounds->offsets[c] = kept;
        for (uint32_t i = begin; i < end; i++) {
            uint32_t vertex = bounds->corners[i];
            if (bounds->last[vertex] == c) continue;
            bounds->last[vertex] = c;
            bounds->corners[kept++] = vertex;
        }
        begin = end;
    }
    bounds->offsets[cell_count] = kept;
}

/* Returns the cell's vertex that is nearest to the mean of its vertices. */
static uint32_t middle_of(const cscd_partition *partition, const double *positions, uint32_t cell) {
    uint32_t begin = partition->cell_offsets[cell], end = partition->cell_offsets[cell + 1];
    uint32_t middle = partition->cell_vertices[begin];
    double mean[3] = {0.0, 0.0, 0.0}, nearest = INFINITY;
    for (uint32_t i = begin; i < end; i++)
        vec3_add_scaled(mean, 1.0 / (end - begin), positions + (size_t)partition->cell_vertices[i] * 3, mean);
    for (uint32_t i = begin; i < end; i++) {
        uint32_t vertex = partition->cell_vertices[i];
        double squared = vec3_squared_distance(positions + (size_t)vertex * 3, mean);
        if (!(squared < nearest)) continue;
        nearest = squared;
        middle = vertex;
    }
    return middle;
}

/* Brings the lists up to date with the partition. */
static void follow_partition(sensor_bounds *bounds, const cscd_partition *partition,
                             const double *positions) {
    if (bounds->generation == partition->generation) return;
    find_homes(bounds, partition);
    list_corners(bounds, partition->cell_count);
    drop_repeated(bounds, partition->cell_count);
    for (uint32_t c = 0; c < partition->cell_count; c++)
        bounds->middles[c] = middle_of(partition, positions, c);
    bounds->generation = partition->generation;
    assert(bounds->offsets[partition->cell_count] <= 3 * bounds->mesh->triangle_count);
}

/* ---- balls --------------------------------------------------------------------------------------------- */

/* Rounding: u = DBL_EPSILON / 2. A difference of two doubles has a relative error of u at most, wherever they
 * lie. Lengths below come from a sum of three squares of such differences, whose relative error is at most 7
 * u as long as nothing underflows, so the root's is at most 5 u: a factor of 1 + 4 DBL_EPSILON = 1 + 8 u, its
 * product rounded, covers it. What squares lose by underflow, at most 3 * 2^-1075 in their sum, is at most
 * 1e-160 in the root. After an overflow, which gives infinity or NaN, parts are not found to be apart. */
#define LENGTH_SLACK     (1.0 + 4.0 * DBL_EPSILON)
#define LENGTH_UNDERFLOW 1e-150

static double length_at_most(double squared) {
    return sqrt(squared) * LENGTH_SLACK + LENGTH_UNDERFLOW;
}

/* The distance of two points that move linearly is convex in time, so it is largest at one of the two ends,
 * and no point of a triangle is farther from a point than the farthest corner. */
static double radius_of(const sensor_bounds *bounds, uint32_t cell, uint32_t centre, const double *start,
                        const double *end) {
    double largest = 0.0;
    for (uint32_t i = bounds->offsets[cell]; i < bounds->offsets[cell + 1]; i++) {
        size_t corner = (size_t)bounds->corners[i] * 3;
        largest = max_of(vec3_squared_distance(start + corner, start + (size_t)centre * 3), largest);
        largest = max_of(vec3_squared_distance(end + corner, end + (size_t)centre * 3), largest);
    }
    return length_at_most(largest);
}

void sensor_bounds_update(sensor_bounds *bounds, const cscd_partition *partition, const double *start,
                          const double *end, const uint32_t *centres) {
    follow_partition(bounds, partition, start);
    if (centres == NULL) centres = bounds->middles;
    for (uint32_t c = 0; c < partition->cell_count; c++) {
        cell_ball *ball = &bounds->balls[c];
        memcpy(ball->start, start + (size_t)centres[c] * 3, sizeof ball->start);
        memcpy(ball->end, end + (size_t)centres[c] * 3, sizeof ball->end);
        ball->radius = radius_of(bounds, c, centres[c], start, end);
    }
}

/* Do the balls stay apart? Let d(t) = (1 - t) d0 + t d1 be the offset between the centres, and m any vector.
 * Then |m| |d(t)| >= m . d(t) >= min(m . d0, m . d1), so the balls stay apart when this minimum exceeds |m|
 * times the sum of the radii. That holds for every m; the shortest d(t) is the best choice.
 *
 * In doubles d0 and d1 have a relative error of u in every coordinate, and their products with m are off by
 * at most 4 u |m| |d| in all. The code subtracts 8 u |m| |d|, which covers the rounding of that term, too.
 * When m is so short that products underflow, the answer is no. */
static bool balls_apart(const cell_ball *a, const cell_ball *b) {
    double d0[3], d1[3], change[3], m[3];
    vec3_subtract(b->start, a->start, d0);
    vec3_subtract(b->end, a->end, d1);
    vec3_subtract(d1, d0, change);
    double along = -vec3_dot(d0, change), whole = vec3_dot(change, change);
    double t = !(along > 0.0) ? 0.0 : along < whole ? along / whole : 1.0;
    vec3_add_scaled(d0, t, change, m);
    double length = length_at_most(vec3_dot(m, m));
    double longest = length_at_most(max_of(vec3_dot(d0, d0), vec3_dot(d1, d1)));
    double reach = (a->radius + b->radius) * LENGTH_SLACK + 4.0 * DBL_EPSILON * longest;
    double gap = min_of(vec3_dot(m, d0), vec3_dot(m, d1));
    return length > 1e-140 && isfinite(gap) && gap > length * reach * LENGTH_SLACK;
}

static bool cell_apart(const cell_ball *cell, const cell_ball *others, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        if (!balls_apart(cell, &others[i])) return false;
    }
    return true;
}

bool sensor_bounds_apart(const sensor_bounds *bounds, const cscd_partition *partition, uint32_t part_a,
                         uint32_t part_b) {
    const cscd_part *a = &partition->parts[part_a], *b = &partition->parts[part_b];
    if (bounds->unbounded[part_a] || bounds->unbounded[part_b]) return false;
    for (uint32_t i = 0; i < a->cell_count; i++) {
        const cell_ball *cell = &bounds->balls[a->first_cell + i];
        if (!cell_apart(cell, bounds->balls + b->first_cell, b->cell_count)) return false;
    }
    return true;
}

/* ---- boxes --------------------------------------------------------------------------------------------- */

static void add_to_box(const double *point, part_box *box) {
    for (int k = 0; k < 3; k++) {
        box->low[k] = min_of(box->low[k], point[k]);
        box->high[k] = max_of(box->high[k], point[k]);
    }
}

void sensor_bounds_update_boxes(sensor_bounds *bounds, const cscd_partition *partition, const double *start,
                                const double *end) {
    follow_partition(bounds, partition, start);
    for (uint32_t p = 0; p < partition->part_count; p++) {
        const cscd_part *part = &partition->parts[p];
        part_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        bounds->boxes[p] = box;
        if (part->cell_count == 0) continue;
        uint32_t behind = part->first_cell + part->cell_count;
        for (uint32_t i = bounds->offsets[part->first_cell]; i < bounds->offsets[behind]; i++) {
            add_to_box(start + (size_t)bounds->corners[i] * 3, &bounds->boxes[p]);
            add_to_box(end + (size_t)bounds->corners[i] * 3, &bounds->boxes[p]);
        }
    }
}

bool sensor_bounds_boxes_apart(const sensor_bounds *bounds, uint32_t part_a, uint32_t part_b) {
    const part_box *a = &bounds->boxes[part_a], *b = &bounds->boxes[part_b];
    if (bounds->unbounded[part_a] || bounds->unbounded[part_b]) return false;
    for (int k = 0; k < 3; k++) {
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return true;
    }
    return false;
}
