/* Partitions: parts, how many cells each gets, and cells that are connected and hold every vertex once. */
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static cscd_sensor_options with_cells(uint32_t cells) {
    cscd_sensor_options options = cscd_sensor_defaults();
    options.cells = cells;
    return options;
}

/* Counts the cells of a body that is one part, when so many are asked for. */
static uint32_t cells_of(const body *b, uint32_t cells) {
    cscd_mesh *mesh = body_mesh(b, 1);
    cscd_sensor_options options = with_cells(cells);
    cscd_sensors *sensors = sensors_of(mesh, NULL, b->positions, &options);
    uint32_t count = cscd_sensors_cell_count(sensors);
    cscd_sensors_destroy(sensors);
    body_mesh_destroy(mesh);
    return count;
}

/* ---- shapes ------------------------------------------------------------------------------------------ */

/* Eight vertices about the origin, which published splitting cannot part. */
TEST(symmetric_cube) {
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    body b = {0};
    for (int i = 0; i < 8; i++) body_add_vertex(&b, (i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1);
    for (int i = 0; i < 6; i++) {
        body_add_triangle(&b, quads[i][0], quads[i][1], quads[i][2]);
        body_add_triangle(&b, quads[i][0], quads[i][2], quads[i][3]);
    }
    assert_true(body_volume(&b) > 0.0);
    for (uint32_t cells = 1; cells <= 8; cells++) assert_int_equal(cells_of(&b, cells), cells);
    assert_int_equal(cells_of(&b, 9), 8);
    assert_int_equal(cells_of(&b, UINT32_MAX), 8);
    body_free(&b);
    b = body_of(BODY_CUBE, 0);
    for (uint32_t cells = 1; cells <= 24; cells++) assert_int_equal(cells_of(&b, cells), cells);
    body_free(&b);
}

TEST(any_number) {
    const body_kind kinds[] = {BODY_SPHERE, BODY_TORUS, BODY_ELLIPSOID};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        body b = body_of(kinds[k], 600);
        for (uint32_t cells = 1; cells <= 33; cells++) assert_int_equal(cells_of(&b, cells), cells);
        body_free(&b);
    }
}

/* Concave bodies: quantization alone would join what lies beside each other but is not connected. */
TEST(concave_bodies) {
    for (int kind = 0; kind < BODY_KIND_COUNT; kind++) {
        body b = body_of((body_kind)kind, body_nearest_count((body_kind)kind, 1500));
        cscd_mesh *mesh = body_mesh(&b, 1);
        for (uint32_t cells = 0; cells <= 64; cells = cells * 2 + 1) {
            cscd_sensor_options options = with_cells(cells);
            cscd_sensors *sensors = sensors_of(mesh, NULL, b.positions, &options);
            assert_int_equal(sensors->partition.object_count, mesh->component_count);
            for (uint32_t p = 0; p < cscd_sensors_part_count(sensors) && cells > 0; p++)
                assert_in_range(cscd_sensors_part(sensors, p).cell_count, 1, cells);
            cscd_sensors_destroy(sensors);
        }
        body_mesh_destroy(mesh);
        body_free(&b);
    }
}

TEST(random_scenes) {
    static scene s;
    random_seed(1);
    for (uint64_t seed = 0; seed < 3; seed++) {
        for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
            scene_make((scene_family)family, seed, &s);
            body b = {s.vertex_count, s.triangle_count, 0, 0, s.x0, s.triangles};
            cscd_mesh *mesh = body_mesh(&b, 1);
            cscd_plan_options plan_options = cscd_plan_defaults();
            cscd_plan *plan = NULL;
            plan_options.method = CSCD_METHOD_KMEANS;
            plan_options.k = (uint32_t)random_integer(1, 60);
            expect_ok(plan_create_packed(mesh, b.positions, &plan_options, &plan));
            cscd_sensor_options options = with_cells((uint32_t)random_integer(0, 20));
            options.within = random_integer(0, 1) == 1;
            options.normal_weight = random_between(0.0, 3.0);
            cscd_sensors *sensors = sensors_of(mesh, plan, b.positions, &options);
            assert_int_equal(cscd_sensors_part_count(sensors), cscd_plan_region_count(plan));
            expect_ok(sensors_renew_packed(sensors, s.x1, UINT32_MAX));
            check_partition(&sensors->partition);
            cscd_sensors_destroy(sensors);
            cscd_plan_destroy(plan);
            body_mesh_destroy(mesh);
        }
    }
}

/* Moved without rounding, and scaled by powers of two, it has the same cells. */
TEST(scale_and_place) {
    const body_kind kinds[] = {BODY_SPHERE, BODY_FIGURE, BODY_CHAIN};
    const double scales[] = {0x1p-250, 0x1p-40, 4.0, 0x1p200};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        body b = body_of(kinds[k], body_nearest_count(kinds[k], 800));
        for (uint32_t i = 0; i < b.vertex_count * 3; i++)
            b.positions[i] = rint(b.positions[i] * 0x1p12) * 0x1p-12;
        cscd_mesh *mesh = body_mesh(&b, 1);
        double *other = body_allocate((size_t)b.vertex_count * 3, sizeof *other);
        cscd_sensors *first = sensors_of(mesh, NULL, b.positions, NULL);
        for (size_t i = 0; i <= sizeof scales / sizeof *scales; i++) {
            for (uint32_t j = 0; j < b.vertex_count * 3; j++)
                other[j] =
                    i > 0 ? b.positions[j] * scales[i - 1] : b.positions[j] + (j % 3 == 1 ? -977.0 : 64.5);
            cscd_sensors *second = sensors_of(mesh, NULL, other, NULL);
            assert_memory_equal(first->partition.vertex_cells, second->partition.vertex_cells,
                                b.vertex_count * sizeof *first->partition.vertex_cells);
            cscd_sensors_destroy(second);
        }
        free(other);
        cscd_sensors_destroy(first);
        body_mesh_destroy(mesh);
        body_free(&b);
    }
}

/* All positions are equal, or some vertices have no triangle. */
TEST(degenerate_meshes) {
    body b = body_of(BODY_SPHERE, 200);
    uint32_t lonely = body_add_vertex(&b, 1.0, 2.0, 3.0);
    cscd_mesh *mesh = body_mesh(&b, 1);
    cscd_sensors *sensors = sensors_of(mesh, NULL, b.positions, NULL);
    assert_int_equal(cscd_sensors_vertex_cell(sensors, lonely), UINT32_MAX);
    assert_int_equal(cscd_sensors_cell_count(sensors), 1); /* there is no other part to watch for */
    cscd_sensors_destroy(sensors);
    for (uint32_t i = 0; i < b.vertex_count * 3; i++) b.positions[i] = 0.3;
    cscd_sensor_options options = with_cells(12);
    sensors = sensors_of(mesh, NULL, b.positions, &options);
    assert_int_equal(cscd_sensors_cell_count(sensors), 1);
    assert_true(cscd_sensors_part(sensors, 0).radius == 0.0);
    cscd_sensors_destroy(sensors);
    body_mesh_destroy(mesh);
    body_free(&b);
}

/* Two cells of a flat ball: by positions alone they lie beside each other, by normals above and below. */
TEST(normals_have_their_weight) {
    body b = body_of(BODY_SPHERE, 800);
    for (uint32_t v = 0; v < b.vertex_count; v++) b.positions[v * 3 + 2] *= 0.1;
    cscd_mesh *mesh = body_mesh(&b, 1);
    for (int weighted = 0; weighted < 2; weighted++) {
        cscd_sensor_options options = with_cells(2);
        options.normal_weight = 4.0 * weighted;
        cscd_sensors *sensors = sensors_of(mesh, NULL, b.positions, &options);
        uint32_t above[2] = {0, 0};
        for (uint32_t v = 0; v < b.vertex_count; v++)
            if (b.positions[v * 3 + 2] > 0.05) above[cscd_sensors_vertex_cell(sensors, v)]++;
        assert_int_equal(above[0] == 0 || above[1] == 0, weighted);
        cscd_sensors_destroy(sensors);
    }
    body_mesh_destroy(mesh);
    body_free(&b);
}

/* ---- renewing ---------------------------------------------------------------------------------------- */

TEST(renewing_one_part) {
    const body_kind kinds[3] = {BODY_SPHERE, BODY_DUMBBELL, BODY_SPHERE};
    sensor_row r = row_of(3, kinds, (double[]){1.0, 1.0, 0.7}, NULL);
    cscd_sensor_part before[3];
    uint32_t *cells = body_allocate(r.b.vertex_count, sizeof *cells);
    for (uint32_t p = 0; p < 3; p++) before[p] = cscd_sensors_part(r.sensors, p);
    memcpy(cells, r.sensors->partition.vertex_cells, r.b.vertex_count * sizeof *cells);
    for (uint32_t v = 0; v < r.b.vertex_count; v++) {
        if (r.sensors->partition.vertex_parts[v] == 1) r.b.positions[v * 3 + 2] *= 5.0;
    }
    expect_ok(sensors_renew_packed(r.sensors, r.b.positions, 1));
    check_partition(&r.sensors->partition);
    cscd_sensor_part after = cscd_sensors_part(r.sensors, 1), last = cscd_sensors_part(r.sensors, 2);
    assert_true(after.cell_count > before[1].cell_count && after.radius > before[1].radius);
    assert_true(last.cell_count == before[2].cell_count && last.radius == before[2].radius);
    uint32_t shift = last.first_cell - before[2].first_cell;
    for (uint32_t v = 0; v < r.b.vertex_count; v++) {
        uint32_t part = r.sensors->partition.vertex_parts[v];
        if (part != 1)
            assert_int_equal(r.sensors->partition.vertex_cells[v], cells[v] + (part == 2 ? shift : 0));
    }
    assert_true(r.sensors->partition.generation == 2 && r.sensors->partition.part_generations[1] == 2);
    assert_true(r.sensors->partition.part_generations[0] == 1 &&
                r.sensors->partition.part_generations[2] == 1);
    cscd_sensors *fresh = sensors_of(r.mesh, NULL, r.b.positions, NULL);
    expect_ok(sensors_renew_packed(r.sensors, r.b.positions, UINT32_MAX));
    assert_memory_equal(fresh->partition.vertex_cells, r.sensors->partition.vertex_cells,
                        r.b.vertex_count * sizeof *cells);
    cscd_sensors_destroy(fresh);
    free(cells);
    row_free(&r);
}

/* ---- scenes ------------------------------------------------------------------------------------------ */

/* Objects of a scene may have several components; obstacles have cells, too, and two are not watched. */
TEST(objects_of_scenes) {
    body chain = body_of(BODY_CHAIN, 0), ball = body_of(BODY_SPHERE, 200), all = {0};
    const body *bodies[4] = {&chain, &ball, &ball, &ball};
    cscd_object_desc descs[4];
    for (uint32_t i = 0; i < 4; i++) {
        descs[i] = cscd_object_of_triangles(bodies[i]->vertex_count, bodies[i]->triangle_count,
                                            bodies[i]->triangles);
        descs[i].obstacle = i >= 2;
        body_append(&all, bodies[i], (double[3]){0, 5.0 * i, 0});
    }
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, descs, 4, &mesh));
    cscd_sensor_options options = cscd_sensor_defaults();
    options.within = true;
    cscd_sensors *sensors = sensors_of(mesh, NULL, all.positions, &options);
    assert_int_equal(sensors->partition.object_count, 4);
    assert_int_equal(cscd_sensors_part_count(sensors), 8);
    for (uint32_t p = 0; p < 8; p++) {
        cscd_sensor_part part = cscd_sensors_part(sensors, p);
        assert_int_equal(part.object, p < 5 ? 0 : p - 4);
        assert_true(part.cell_count > 1);
        for (uint32_t q = 0; q < 8; q++)
            assert_true(partition_watches(&sensors->partition, p, q) == (p != q && (p < 6 || q < 6)));
    }
    cscd_sensors_destroy(sensors);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    body_free(&all);
    body_free(&ball);
    body_free(&chain);
}

/* Balls of these radii, as objects of their own or in the first one; the last ones are obstacles. Returns a part's cells. */
static uint32_t cells_of_ball(const double radii[3], bool two_in_one, uint32_t obstacles, uint32_t part) {
    body all = {0};
    cscd_object_desc descs[3];
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    const uint32_t count = two_in_one ? 2 : 3;
    for (uint32_t i = 0; i < 3; i++) {
        body ball = body_of(BODY_SPHERE, 800);
        for (uint32_t k = 0; k < 3 * ball.vertex_count; k++) ball.positions[k] *= radii[i];
        body_append(&all, &ball, (double[3]){0, 5.0 * i, 0});
        body_free(&ball);
    }
    const uint32_t vertices = all.vertex_count / 3, triangles = all.triangle_count / 3;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t balls = two_in_one && i == 0 ? 2 : 1;
        descs[i] = cscd_object_of_triangles(balls * vertices, balls * triangles, all.triangles);
        descs[i].obstacle = i + obstacles >= count;
    }
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, descs, count, &mesh), CSCD_OK);
    cscd_sensors *sensors = sensors_of(mesh, NULL, all.positions, NULL);
    assert_int_equal(cscd_sensors_part_count(sensors), 3);
    const uint32_t cells = cscd_sensors_part(sensors, part).cell_count;
    cscd_sensors_destroy(sensors);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    body_free(&all);
    return cells;
}

/* Obstacles have cells for bodies alone, and parts of one object for other objects. */
TEST(cells_are_for_what_is_watched) {
    assert_int_equal(cells_of_ball((double[3]){1.0, 1.0, 0.125}, false, 0, 1), 64);
    assert_int_equal(cells_of_ball((double[3]){1.0, 1.0, 0.125}, false, 2, 1), 12);
    assert_int_equal(cells_of_ball((double[3]){1.0, 1.0, 0.125}, false, 2, 0), 64);
    assert_int_equal(cells_of_ball((double[3]){0.25, 0.5, 1.0}, true, 0, 0),
                     cells_of_ball((double[3]){0.25, 2.0, 1.0}, true, 0, 0));
    assert_int_equal(cells_of_ball((double[3]){0.5, 0.25, 1.0}, true, 0, 1),
                     cells_of_ball((double[3]){2.0, 0.25, 1.0}, true, 0, 1));
}

/* ---- what is refused --------------------------------------------------------------------------------- */

static void check_refused(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                          const cscd_sensor_options *options, const char *word) {
    cscd_sensors *sensors = NULL;
    assert_int_equal(sensors_create_packed(mesh, plan, positions, options, &sensors), CSCD_INVALID_ARGUMENT);
    assert_null(sensors);
    if (strstr(cscd_context_detail(mesh->context), word) == NULL)
        fail_msg("\"%s\" does not name %s", cscd_context_detail(mesh->context), word);
}

TEST(bad_arguments) {
    body b = body_of(BODY_SPHERE, 200), other = body_of(BODY_CUBE, 0);
    cscd_mesh *mesh = body_mesh(&b, 1), *other_mesh = body_mesh(&other, 1);
    cscd_plan_options plan_options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    plan_options.method = CSCD_METHOD_SINGLE;
    expect_ok(plan_create_packed(other_mesh, other.positions, &plan_options, &plan));
    const double weights[] = {NAN, -1.0, INFINITY, 2e6}, shares[] = {NAN, -1e-3, 1.0, INFINITY};
    for (int i = 0; i < 4; i++) {
        cscd_sensor_options options = cscd_sensor_defaults();
        options.normal_weight = weights[i];
        check_refused(mesh, NULL, b.positions, &options, "normal_weight");
        options = cscd_sensor_defaults();
        options.epsilon = shares[i];
        check_refused(mesh, NULL, b.positions, &options, "epsilon");
    }
    cscd_sensor_options options = cscd_sensor_defaults();
    options.cells_max = 0;
    check_refused(mesh, NULL, b.positions, &options, "cells_max");
    memset(&options, 0, sizeof options);
    check_refused(mesh, NULL, b.positions, &options, "cscd_sensor_defaults");
    check_refused(mesh, plan, b.positions, NULL, "another mesh");
    check_refused(mesh, NULL, NULL, NULL, "positions is NULL");
    cscd_sensors *sensors = NULL;
    assert_int_equal(sensors_create_packed(NULL, NULL, b.positions, NULL, &sensors), CSCD_NULL_OBJECT);
    assert_int_equal(sensors_create_packed(mesh, NULL, b.positions, NULL, NULL), CSCD_INVALID_ARGUMENT);
    sensors = sensors_of(mesh, NULL, b.positions, NULL);
    assert_int_equal(sensors_renew_packed(NULL, b.positions, 0), CSCD_NULL_OBJECT);
    expect_invalid(mesh->context, sensors_renew_packed(sensors, b.positions, 1), "part is 1");
    assert_int_equal(sensors_renew_packed(sensors, NULL, 0), CSCD_INVALID_ARGUMENT);
    b.positions[4] = NAN;
    assert_int_equal(sensors_renew_packed(sensors, b.positions, 0), CSCD_INVALID_ARGUMENT);
    check_partition(&sensors->partition);
    check_refused(mesh, NULL, b.positions, NULL, "vertex 1 has y");
    b.positions[4] = 0x1p301;
    check_refused(mesh, NULL, b.positions, NULL, "vertex 1 has y");
    cscd_sensors_destroy(sensors);
    cscd_sensors_destroy(NULL);
    cscd_plan_destroy(plan);
    body_mesh_destroy(other_mesh);
    body_mesh_destroy(mesh);
    body_free(&other);
    body_free(&b);
}
