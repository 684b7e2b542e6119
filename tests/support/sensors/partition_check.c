/* Asserts what holds for every partition, and makes bodies to divide. */
#include "tests/support/sensors/partition_check.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>

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
