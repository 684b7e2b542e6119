/* A context, a mesh, a plan and sensors for a scene; partitions made by hand, and the invariants of every partition. */
#include "tests/support/sensors/sensor_rig.h"

#include "src/core/vec3.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* NULL goes on as NULL. */
static const cscd_view *view_of_packed(const cscd_mesh *mesh, const double *positions, cscd_view *view) {
    if (positions == NULL || mesh == NULL) return NULL;
    *view = cscd_view_doubles(positions, mesh->vertex_count);
    return view;
}

cscd_status sensors_create_packed(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                                  const cscd_sensor_options *options, cscd_sensors **out) {
    cscd_view x;
    cscd_context *context = mesh != NULL ? mesh->context : NULL;
    return cscd_sensors_create(context, mesh, plan, view_of_packed(mesh, positions, &x), options, out);
}

cscd_status sensors_renew_packed(cscd_sensors *sensors, const double *positions, uint32_t part) {
    cscd_view x;
    const cscd_mesh *mesh = sensors != NULL ? sensors->mesh : NULL;
    return cscd_sensors_renew(sensors, view_of_packed(mesh, positions, &x), part);
}

cscd_status sensors_step_packed(cscd_sensors *sensors, const double *x0, const double *x1,
                                cscd_warnings *out) {
    const cscd_mesh *mesh = sensors != NULL ? sensors->mesh : NULL;
    cscd_view from, to;
    return cscd_sensors_step(sensors, view_of_packed(mesh, x0, &from), view_of_packed(mesh, x1, &to), out);
}

sensor_rig sensor_rig_create(const scene *s, const sensor_setup *setup) {
    static const sensor_setup defaults = {0, NULL};
    if (setup == NULL) setup = &defaults;
    sensor_rig r = {NULL, NULL, NULL, NULL};
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    assert_int_equal(cscd_context_create(NULL, &r.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r.context, &desc, 1, &r.mesh), CSCD_OK);
    if (setup->regions > 0) {
        cscd_plan_options options = cscd_plan_defaults();
        options.method = CSCD_METHOD_KMEANS;
        options.k = setup->regions;
        assert_int_equal(plan_create_packed(r.mesh, s->x0, &options, &r.plan), CSCD_OK);
    }
    assert_int_equal(sensors_create_packed(r.mesh, r.plan, s->x0, setup->sensors, &r.sensors), CSCD_OK);
    return r;
}

void sensor_rig_destroy(sensor_rig *r) {
    cscd_sensors_destroy(r->sensors);
    cscd_plan_destroy(r->plan);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

cscd_warnings sensor_rig_step(const sensor_rig *r, const double *start, const double *end) {
    cscd_warnings found;
    assert_int_equal(sensors_step_packed(r->sensors, start, end, &found), CSCD_OK);
    return found;
}

static bool of_objects(const cscd_warning *w, uint32_t a, uint32_t b) {
    return (w->object_a == a && w->object_b == b) || (w->object_a == b && w->object_b == a);
}

const cscd_warning *find_warning(const cscd_warnings *warnings, uint32_t object_a, uint32_t object_b) {
    for (size_t i = 0; i < warnings->count; i++)
        if (of_objects(&warnings->items[i], object_a, object_b)) return &warnings->items[i];
    return NULL;
}

const cscd_warning *find_contact(const cscd_warnings *warnings, uint32_t object_a, uint32_t object_b) {
    const cscd_warning *first = NULL;
    for (size_t i = 0; i < warnings->count; i++) {
        const cscd_warning *w = &warnings->items[i];
        if (!w->contact || !of_objects(w, object_a, object_b)) continue;
        if (first == NULL || w->toi < first->toi) first = w;
    }
    return first;
}

/* ---- tubes -----------------------------------------------------------------------------------------------
 */

static uint32_t add_vertex(scene *s, double x, double y, double z) {
    assert(s->vertex_count < SCENE_VERTICES_MAX);
    double p[3] = {x, y, z};
    for (int k = 0; k < 3; k++)
        s->x0[s->vertex_count * 3 + (uint32_t)k] = s->x1[s->vertex_count * 3 + (uint32_t)k] = p[k];
    return s->vertex_count++;
}

static void add_triangle(scene *s, uint32_t a, uint32_t b, uint32_t c) {
    assert(s->triangle_count < SCENE_TRIANGLES_MAX);
    uint32_t *t = s->triangles + (size_t)s->triangle_count++ * 3;
    t[0] = a, t[1] = b, t[2] = c;
}

/* Computes the unit normal of the path at point i, within the path's plane. */
static void across_path(const double (*path)[3], int count, int i, double normal[2]) {
    int before = i > 0 ? i - 1 : i, after = i < count - 1 ? i + 1 : i;
    double x = path[after][0] - path[before][0], y = path[after][1] - path[before][1];
    double length = sqrt(x * x + y * y);
    normal[0] = -y / length;
    normal[1] = x / length;
}

void scene_add_tube(scene *s, const double (*path)[3], int count, double radius, int segments) {
    uint32_t n = (uint32_t)segments, rings = (uint32_t)count, first = s->vertex_count;
    for (int i = 0; i < count; i++) {
        double normal[2];
        across_path(path, count, i, normal);
        for (uint32_t j = 0; j < n; j++) {
            double angle = 2.0 * 3.14159265358979 * j / n, out = radius * cos(angle);
            add_vertex(s, path[i][0] + out * normal[0], path[i][1] + out * normal[1],
                       path[i][2] + radius * sin(angle));
        }
    }
    for (uint32_t i = 0; i + 1 < rings; i++) {
        for (uint32_t j = 0; j < n; j++) {
            uint32_t a = first + i * n + j, b = first + i * n + (j + 1) % n;
            add_triangle(s, a, b, b + n);
            add_triangle(s, a, b + n, a + n);
        }
    }
    uint32_t begin = add_vertex(s, path[0][0], path[0][1], path[0][2]), last = rings - 1;
    uint32_t end = add_vertex(s, path[last][0], path[last][1], path[last][2]);
    for (uint32_t j = 0; j < n; j++) {
        add_triangle(s, begin, first + (j + 1) % n, first + j);
        add_triangle(s, end, first + last * n + j, first + last * n + (j + 1) % n);
    }
}

void scene_add_bent_tube(scene *s, const double (*corners)[3], int count, double radius, double step) {
    double path[256][3];
    int points = 0;
    for (int c = 0; c + 1 < count; c++) {
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = corners[c + 1][k] - corners[c][k];
        int steps = (int)ceil(sqrt(d[0] * d[0] + d[1] * d[1]) / step);
        for (int i = c > 0; i <= steps; i++, points++) {
            assert(points < 256);
            for (int k = 0; k < 3; k++) path[points][k] = corners[c][k] + d[k] * i / steps;
        }
    }
    scene_add_tube(s, (const double(*)[3])path, points, radius, 8);
}

void shift_vertices(uint32_t first, uint32_t end, const double by[3], double *x) {
    for (uint32_t v = first; v < end; v++)
        for (uint32_t k = 0; k < 3; k++) x[v * 3 + k] += by[k];
}

/* ---- partitions made by hand --------------------------------------------------------------------------- */

static void *allocate_zeros(size_t count, size_t size) {
    void *block = calloc(count + 1, size);
    if (block == NULL) abort();
    return block;
}

static sensor_partition *allocate_partition(const cscd_mesh *mesh, uint32_t part_count) {
    size_t vertices = mesh->vertex_count;
    sensor_partition *p = allocate_zeros(1, sizeof *p);
    static const cscd_sensor_options none;
    *p = (sensor_partition){
        .context = mesh->context, .mesh = mesh, .options = &none, .part_count = part_count};
    p->object_count = part_count;
    p->object_obstacles = allocate_zeros(part_count, sizeof *p->object_obstacles);
    p->parts = allocate_zeros(part_count, sizeof *p->parts);
    p->triangle_parts = allocate_zeros(mesh->triangle_count, sizeof(uint32_t));
    p->vertex_parts = allocate_zeros(vertices, sizeof(uint32_t));
    p->part_vertex_offsets = allocate_zeros((size_t)part_count + 1, sizeof(uint32_t));
    p->part_vertices = allocate_zeros(vertices, sizeof(uint32_t));
    p->vertex_cells = allocate_zeros(vertices, sizeof(uint32_t));
    p->cell_parts = allocate_zeros(vertices, sizeof(uint32_t));
    p->cell_offsets = allocate_zeros(vertices + 1, sizeof(uint32_t));
    p->cell_vertices = allocate_zeros(vertices, sizeof(uint32_t));
    p->part_generations = allocate_zeros(part_count, sizeof(uint64_t));
    p->generation = 1;
    for (uint32_t i = 0; i < part_count; i++) p->part_generations[i] = 1;
    return p;
}

static void list_part_vertices(sensor_partition *p) {
    const cscd_mesh *mesh = p->mesh;
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t *star = mesh->vertex_stars + mesh->vertex_star_offsets[v];
        bool used = mesh->vertex_star_offsets[v + 1] > mesh->vertex_star_offsets[v];
        p->vertex_parts[v] = used ? p->triangle_parts[star[0]] : PARTITION_NONE;
        p->vertex_cells[v] = PARTITION_NONE;
    }
    for (uint32_t i = 0; i < p->part_count; i++) {
        p->part_vertex_offsets[i] = count;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            if (p->vertex_parts[v] == i) p->part_vertices[count++] = v;
        }
    }
    p->part_vertex_offsets[p->part_count] = count;
}

static double squared_distance(const double *positions, uint32_t a, uint32_t b) {
    double offset[3];
    vec3_subtract(positions + (size_t)a * 3, positions + (size_t)b * 3, offset);
    return vec3_dot(offset, offset);
}

/* Gives each vertex of the part to the nearest of the centres, or to the first of equally near ones. */
static void make_cells(sensor_partition *p, const double *positions, uint32_t part, uint32_t cells_max) {
    const uint32_t *vertices = p->part_vertices + p->part_vertex_offsets[part];
    uint32_t count = p->part_vertex_offsets[part + 1] - p->part_vertex_offsets[part], made = 0;
    uint32_t *nearest = allocate_zeros(count, sizeof *nearest), centres[64];
    p->parts[part] = (cscd_sensor_part){.object = part, .first_cell = p->cell_count};
    for (uint32_t c = 0; c < cells_max && count > 0; c++)
        centres[c] = vertices[random_integer(0, (int)count - 1)];
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t c = 1; c < cells_max; c++) {
            double to_best = squared_distance(positions, vertices[i], centres[nearest[i]]);
            if (squared_distance(positions, vertices[i], centres[c]) < to_best) nearest[i] = c;
        }
    }
    uint32_t place = p->cell_offsets[p->cell_count];
    for (uint32_t c = 0; c < cells_max; c++) {
        uint32_t cell = p->cell_count + made, begin = place;
        for (uint32_t i = 0; i < count; i++) {
            if (nearest[i] != c) continue;
            p->vertex_cells[vertices[i]] = cell;
            p->cell_vertices[place++] = vertices[i];
        }
        if (place == begin) continue;
        p->cell_parts[cell] = part;
        p->cell_offsets[cell + 1] = place;
        made++;
    }
    p->parts[part].cell_count = made;
    p->cell_count += made;
    free(nearest);
}

sensor_partition *hand_partition_create(const cscd_mesh *mesh, const double *positions,
                                        const uint32_t *triangle_parts, uint32_t part_count,
                                        uint32_t cells_max) {
    sensor_partition *p = allocate_partition(mesh, part_count);
    memcpy(p->triangle_parts, triangle_parts != NULL ? triangle_parts : mesh->triangle_components,
           mesh->triangle_count * sizeof(uint32_t));
    list_part_vertices(p);
    for (uint32_t i = 0; i < part_count; i++) make_cells(p, positions, i, cells_max);
    return p;
}

void hand_partition_destroy(sensor_partition *p) {
    free(p->object_obstacles);
    free(p->parts);
    free(p->triangle_parts);
    free(p->vertex_parts);
    free(p->part_vertex_offsets);
    free(p->part_vertices);
    free(p->vertex_cells);
    free(p->cell_parts);
    free(p->cell_offsets);
    free(p->cell_vertices);
    free(p->part_generations);
    free(p);
}

void hand_partition_particles(const sensor_partition *p, uint32_t *out) {
    for (uint32_t c = 0; c < p->cell_count; c++) {
        int begin = (int)p->cell_offsets[c], end = (int)p->cell_offsets[c + 1];
        out[c] = p->cell_vertices[random_integer(begin, end - 1)];
    }
}

/* ---- partitions ---------------------------------------------------------------------------------------- */

static uint32_t triangles_in(const sensor_partition *partition, uint32_t vertex, uint32_t part) {
    uint32_t count = 0, in_part = 0;
    const uint32_t *star = cscd_mesh_vertex_triangles(partition->mesh, vertex, &count);
    for (uint32_t i = 0; i < count; i++) in_part += partition->triangle_parts[star[i]] == part;
    return in_part;
}

static void check_vertex(const sensor_partition *partition, uint32_t vertex) {
    uint32_t count = 0, part = partition->vertex_parts[vertex];
    uint32_t cell = partition->vertex_cells[vertex];
    const uint32_t *star = cscd_mesh_vertex_triangles(partition->mesh, vertex, &count);
    assert_true((count > 0) == (part != PARTITION_NONE) && (count > 0) == (cell != PARTITION_NONE));
    if (count == 0) return;
    uint32_t own = triangles_in(partition, vertex, part);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t other = partition->triangle_parts[star[i]], others = triangles_in(partition, vertex, other);
        assert_true(own > others || (own == others && part <= other));
    }
    assert_int_equal(partition->cell_parts[cell], part);
}

static void check_parts(const sensor_partition *partition) {
    uint32_t next = 0;
    for (uint32_t p = 0; p < partition->part_count; p++) {
        cscd_sensor_part part = partition->parts[p];
        assert_int_equal(part.first_cell, next);
        assert_true(part.object < partition->object_count);
        assert_true(isfinite(part.radius) && part.radius >= 0.0);
        uint32_t vertices = partition->part_vertex_offsets[p + 1] - partition->part_vertex_offsets[p];
        assert_true((vertices > 0) == (part.cell_count > 0) && part.cell_count <= vertices);
        for (uint32_t i = 0; i < part.cell_count; i++) assert_int_equal(partition->cell_parts[next + i], p);
        next += part.cell_count;
    }
    assert_int_equal(next, partition->cell_count);
}

/* Counts the cell's vertices that are connected to its first one by neighbours. */
static uint32_t count_reached(const sensor_partition *partition, uint32_t cell, bool *seen, uint32_t *stack) {
    uint32_t top = 0, count = 0;
    stack[top++] = partition->cell_vertices[partition->cell_offsets[cell]];
    seen[stack[0]] = true;
    while (top > 0) {
        uint32_t v = stack[--top];
        count++;
        for (uint32_t i = partition->neighbour_offsets[v]; i < partition->neighbour_offsets[v + 1]; i++) {
            uint32_t neighbour = partition->neighbours[i];
            assert_int_equal(partition->vertex_cells[neighbour], cell);
            assert_true(i == partition->neighbour_offsets[v] || partition->neighbours[i - 1] < neighbour);
            if (seen[neighbour]) continue;
            seen[neighbour] = true;
            stack[top++] = neighbour;
        }
    }
    return count;
}

static void check_cells(const sensor_partition *partition) {
    uint32_t vertex_count = partition->mesh->vertex_count, listed = 0;
    bool *seen = calloc(vertex_count, sizeof *seen);
    uint32_t *stack = calloc(vertex_count, sizeof *stack);
    assert_true(seen != NULL && stack != NULL);
    for (uint32_t c = 0; c < partition->cell_count; c++) {
        uint32_t begin = partition->cell_offsets[c], end = partition->cell_offsets[c + 1];
        assert_true(begin == listed && begin < end);
        for (uint32_t i = begin; i < end; i++) {
            assert_int_equal(partition->vertex_cells[partition->cell_vertices[i]], c);
            assert_true(i == begin || partition->cell_vertices[i - 1] < partition->cell_vertices[i]);
        }
        assert_int_equal(count_reached(partition, c, seen, stack), end - begin);
        listed = end;
    }
    for (uint32_t v = 0; v < vertex_count; v++)
        assert_true(seen[v] == (partition->vertex_cells[v] != PARTITION_NONE));
    free(stack);
    free(seen);
}

/* Checks that every edge within a cell is in the lists of both its ends. */
static void check_neighbours(const sensor_partition *partition) {
    uint32_t inner = 0;
    for (uint32_t e = 0; e < partition->mesh->edge_count; e++) {
        const uint32_t *v = partition->mesh->edges[e];
        inner += partition->vertex_cells[v[0]] == partition->vertex_cells[v[1]];
    }
    assert_int_equal(partition->neighbour_offsets[partition->mesh->vertex_count], 2 * inner);
}

void check_partition(const sensor_partition *partition) {
    for (uint32_t v = 0; v < partition->mesh->vertex_count; v++) check_vertex(partition, v);
    check_parts(partition);
    check_cells(partition);
    check_neighbours(partition);
}

cscd_sensors *sensors_of(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                         const cscd_sensor_options *options) {
    cscd_sensors *sensors = NULL;
    expect_ok(sensors_create_packed(mesh, plan, positions, options, &sensors));
    check_partition(&sensors->partition);
    return sensors;
}

sensor_row row_of(uint32_t count, const body_kind *kinds, const double *scales,
                  const cscd_sensor_options *options) {
    sensor_row r = {0};
    for (uint32_t i = 0; i < count; i++) {
        body one = body_of(kinds[i], body_nearest_count(kinds[i], 600));
        for (uint32_t j = 0; j < one.vertex_count * 3; j++) one.positions[j] *= scales[i];
        body_append(&r.b, &one, (double[3]){20.0 * i, 0, 0});
        body_free(&one);
    }
    r.mesh = body_mesh(&r.b, 1);
    r.sensors = sensors_of(r.mesh, NULL, r.b.positions, options);
    return r;
}

void row_free(sensor_row *r) {
    cscd_sensors_destroy(r->sensors);
    body_mesh_destroy(r->mesh);
    body_free(&r->b);
}
