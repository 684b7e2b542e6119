/* The unknowns of two sheets that a seam joins: what is pinned, neighbours, masses, and regions that grow. */
#include "runtime/untangle/vertex_graph.h"
#include "tests/support/calls.h"
#include "tests/support/scenes.h"

#include <math.h>

enum { SIDE = 4, ONE = SIDE * SIDE, ALL = 2 * ONE };

typedef struct sewn_sheets {
    cscd_context *context;
    cscd_mesh *mesh;
    vertex_graph graph;
    vertex_region region;
    double x[ALL * 3], weights[ALL];
    uint32_t names[ALL];
} sewn_sheets;

/* The vertex `seam` of the second sheet is one with the vertex `seam` of the first. */
static void sheets_open(sewn_sheets *s, uint32_t seam, uint32_t pinned) {
    static scene sheet;
    scene_clear(&sheet);
    scene_add_sheet(&sheet, 3.0, 3.0, SIDE - 1, SIDE - 1);
    assert_int_equal(sheet.vertex_count, ONE);
    const cscd_object_desc one = cscd_object_of_triangles(ONE, sheet.triangle_count, sheet.triangles);
    const cscd_object_desc objects[2] = {one, one};
    for (uint32_t v = 0; v < ALL; v++) {
        s->names[v] = v == ONE + seam ? seam : v;
        s->weights[v] = v == pinned ? (double)INFINITY : 1.0;
        memcpy(s->x + 3 * (size_t)v, sheet.x0 + 3 * (size_t)(v % ONE), sizeof(double[3]));
    }
    const graph_source from = {.positions = s->x, .names = s->names, .weights = s->weights};
    expect_ok(cscd_context_create(NULL, &s->context));
    expect_ok(cscd_mesh_create(s->context, objects, 2, &s->mesh));
    expect_ok(vertex_graph_make(&s->graph, s->context, s->mesh, &from));
    s->region = (vertex_region){.count = 0};
    assert_true(vertex_region_make(&s->region, &s->graph));
}

static void sheets_close(sewn_sheets *s) {
    vertex_region_free(&s->region, s->context);
    vertex_graph_free(&s->graph);
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
}

TEST(a_pin_holds_all_of_its_seam) {
    for (int other = 0; other < 2; other++) { /* the first vertex of the seam is pinned, or the second */
        static sewn_sheets s;
        sheets_open(&s, 5, other ? ONE + 5 : 5);
        for (uint32_t v = 0; v < ALL; v++) assert_true(s.graph.fixed[v] == (v == 5 || v == ONE + 5));
        sheets_close(&s);
    }
}

TEST(seams_are_one_unknown) {
    static sewn_sheets s;
    sheets_open(&s, 5, ALL);
    const vertex_graph *g = &s.graph;
    size_t of_seam = 0;
    for (size_t k = g->begins[5]; k < g->begins[6]; k++) of_seam += g->neighbours[k] >= ONE;
    assert_true(of_seam > 0 && 2 * of_seam == g->begins[6] - g->begins[5]);
    assert_true(g->begins[ONE + 5] == g->begins[ONE + 6]);
    double mass = 0.0, sum = 0.0;
    for (uint32_t v = 0; v < ALL; v++) mass += s.names[v] == v ? g->masses[v] : 0.0;
    for (size_t k = g->begins[5]; k < g->begins[6]; k++) sum += g->couplings[k];
    assert_true(fabs(mass - 18.0) < 1e-12 && fabs(sum - g->coupled[5]) < 1e-12);
    assert_true(g->masses[ONE + 5] == g->masses[5]);
    for (uint32_t v = 0; v < ALL; v++) { /* as strong from either end */
        for (size_t k = g->begins[v]; k < g->begins[v + 1]; k++) {
            double back = 0.0;
            for (size_t l = g->begins[g->neighbours[k]]; l < g->begins[g->neighbours[k] + 1]; l++)
                back += g->neighbours[l] == v ? g->couplings[l] : 0.0;
            assert_true(back == g->couplings[k]);
        }
    }
    sheets_close(&s);
}

TEST(regions_grow_through_seams_and_stop_at_pins) {
    for (int pinned = 0; pinned < 2; pinned++) {
        static sewn_sheets s;
        sheets_open(&s, 5, pinned ? ONE + 5 : ALL);
        vertex_region_add(&s.region, &s.graph, 0);
        vertex_region_add(&s.region, &s.graph, 0);
        assert_int_equal(s.region.count, 1);
        vertex_region_grow(&s.region, &s.graph, 1);
        assert_true(s.region.count > 2 && s.region.count <= 4);
        vertex_region_grow(&s.region, &s.graph, ALL);
        assert_int_equal(s.region.count, pinned ? ONE - 1 : ALL - 1);
        for (uint32_t row = 0; row < s.region.count; row++)
            assert_int_equal(vertex_region_row(&s.region, &s.graph, s.region.vertices[row]), row);
        assert_true(vertex_region_row(&s.region, &s.graph, ONE + 5) == (pinned ? NO_ROW : s.region.rows[5]));
        vertex_region_clear(&s.region);
        for (uint32_t v = 0; v < ALL; v++) assert_true(s.region.rows[v] == NO_ROW);
        sheets_close(&s);
    }
}
