/* Meshes with wires, points and half-spaces: features, hash, bad input, memory. */
#include "cscd/cscd.h"
#include "src/mesh/mesh.h"
#include "tests/support/changing_mesh.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static const uint32_t tetrahedron[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
static const uint32_t wires[10] = {3, 1, 0, 1, 1, 0, 2, 3, 3, 1}; /* two are given twice */
static const double normal[3] = {0.0, 3.0, -4.0};

enum { MIXED = 6 };

/* A tetrahedron between loose objects. */
static void describe_mixed(cscd_object_desc out[MIXED]) {
    out[0] = cscd_object_of_points(2);
    out[1] = cscd_object_of_wires(5, 5, wires);
    out[2] = cscd_object_of_triangles(5, 4, tetrahedron);
    out[3] = cscd_object_half_space(normal);
    out[4] = cscd_object_of_wires(4, 4, wires);
    out[5] = cscd_object_of_points(3);
    out[1].obstacle = out[3].obstacle = true;
}

static void check_object(const cscd_mesh *mesh, uint32_t object, const uint32_t expected[6],
                         cscd_object_kind kind, bool obstacle) {
    cscd_object o = cscd_mesh_object(mesh, object);
    assert_int_equal(o.kind, kind);
    assert_int_equal(o.obstacle, obstacle);
    const uint32_t found[6] = {o.first_vertex, o.vertex_count,   o.first_edge,
                               o.edge_count,   o.first_triangle, o.triangle_count};
    for (int i = 0; i < 6; i++) assert_int_equal(found[i], expected[i]);
    for (uint32_t v = 0; v < o.vertex_count; v++)
        assert_int_equal(cscd_mesh_vertex_object(mesh, o.first_vertex + v), object);
}

static void check_features(const cscd_mesh *mesh) {
    static const uint32_t edges[12][2] = {{2, 3}, {3, 5},  {4, 5},  {7, 8},   {7, 9},   {7, 10},
                                          {8, 9}, {8, 10}, {9, 10}, {13, 14}, {14, 16}, {15, 16}};
    assert_int_equal(cscd_mesh_vertex_count(mesh), 20);
    assert_int_equal(cscd_mesh_triangle_count(mesh), 4);
    assert_int_equal(cscd_mesh_edge_count(mesh), 12);
    assert_memory_equal(cscd_mesh_array(mesh, CSCD_EDGE_VERTICES), edges, sizeof edges);
    for (uint32_t e = 0; e < 12; e++) {
        uint32_t count, v[2];
        cscd_mesh_edge_triangles(mesh, e, &count);
        cscd_mesh_edge(mesh, e, v);
        assert_int_equal(count, e >= 3 && e < 9 ? 2 : 0);
        assert_true(v[0] == edges[e][0] && v[1] == edges[e][1]);
    }
    for (uint32_t v = 0; v < 20; v++) {
        uint32_t count;
        cscd_mesh_vertex_triangles(mesh, v, &count);
        assert_int_equal(count, v >= 7 && v < 11 ? 3 : 0);
    }
    for (uint32_t t = 0; t < 4; t++) {
        uint32_t v[3], e[3];
        cscd_mesh_triangle(mesh, t, v);
        cscd_mesh_triangle_edges(mesh, t, e);
        for (int i = 0; i < 3; i++) {
            uint32_t a = v[i], b = v[(i + 1) % 3];
            assert_true(edges[e[i]][0] == (a < b ? a : b) && edges[e[i]][1] == (a < b ? b : a));
        }
    }
}

TEST(mixed_objects) {
    cscd_object_desc descs[MIXED];
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    cscd_mesh *mesh = NULL;
    describe_mixed(descs);
    assert_int_equal(cscd_mesh_create(context, descs, MIXED, &mesh), CSCD_OK);
    check_object(mesh, 0, (uint32_t[]){0, 2, 0, 0, 0, 0}, CSCD_OBJECT_POINTS, false);
    check_object(mesh, 1, (uint32_t[]){2, 5, 0, 3, 0, 0}, CSCD_OBJECT_WIRES, true);
    check_object(mesh, 2, (uint32_t[]){7, 5, 3, 6, 0, 4}, CSCD_OBJECT_TRIANGLES, false);
    check_object(mesh, 3, (uint32_t[]){12, 1, 9, 0, 4, 0}, CSCD_OBJECT_HALF_SPACE, true);
    check_object(mesh, 4, (uint32_t[]){13, 4, 9, 3, 4, 0}, CSCD_OBJECT_WIRES, false);
    check_object(mesh, 5, (uint32_t[]){17, 3, 12, 0, 4, 0}, CSCD_OBJECT_POINTS, false);
    check_features(mesh);
    assert_int_equal(cscd_mesh_component_count(mesh), 1);
    cscd_component c = cscd_mesh_component(mesh, 0);
    assert_true(c.closed_manifold && c.vertex_count == 4 && c.edge_count == 6 && c.triangle_count == 4);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}

/* ---- the hash -------------------------------------------------------------------------------------------- */

static uint64_t hash_of(cscd_context *context, const cscd_object_desc *descs, uint32_t count) {
    cscd_mesh *mesh = NULL;
    assert_int_equal(cscd_mesh_create(context, descs, count, &mesh), CSCD_OK);
    uint64_t hash = cscd_mesh_hash(mesh);
    cscd_mesh_destroy(mesh);
    return hash;
}

/* Meshes of the same triangles and as many vertices differ by their loose objects. */
TEST(hashes_differ) {
    static const uint32_t other_wires[4] = {0, 1, 1, 2};
    static const double other[3] = {0.0, 3.0, 4.0};
    counting_allocator counter = counting_allocator_start();
    uint64_t hashes[6];
    cscd_context *context = context_of(0, &counter);
    cscd_object_desc descs[2] = {cscd_object_of_triangles(4, 4, tetrahedron), cscd_object_of_points(4)};
    hashes[0] = hash_of(context, descs, 2);
    descs[1] = cscd_object_of_wires(4, 2, wires);
    hashes[1] = hash_of(context, descs, 2);
    descs[1] = cscd_object_of_wires(4, 2, other_wires);
    hashes[2] = hash_of(context, descs, 2);
    descs[0] = cscd_object_of_triangles(7, 4, tetrahedron);
    descs[1] = cscd_object_half_space(normal);
    hashes[3] = hash_of(context, descs, 2);
    descs[1] = cscd_object_half_space(other);
    hashes[4] = hash_of(context, descs, 2);
    descs[0] = cscd_object_of_triangles(8, 4, tetrahedron);
    hashes[5] = hash_of(context, descs, 1);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < i; k++) assert_true(hashes[i] != hashes[k]);
    }
    cscd_context_destroy(context);
}

/* ---- bad input ------------------------------------------------------------------------------------------ */

static void check_refused(cscd_context *context, cscd_object_desc desc, cscd_status expected,
                          const char *detail) {
    const cscd_object_desc descs[2] = {cscd_object_of_triangles(4, 4, tetrahedron), desc};
    cscd_mesh *mesh = NULL;
    assert_int_equal(cscd_mesh_create(context, descs, 2, &mesh), expected);
    assert_null(mesh);
    if (strstr(cscd_context_detail(context), detail) == NULL ||
        strstr(cscd_context_detail(context), "object 1: ") == NULL)
        fail_msg("no '%s' in '%s'", detail, cscd_context_detail(context));
}

static cscd_object_desc half_space_along(double x, double y, double z) {
    const double n[3] = {x, y, z};
    return cscd_object_half_space(n);
}

TEST(refused_descriptions) {
    static const uint32_t beyond[4] = {0, 1, 2, 4}, itself[4] = {0, 1, 2, 2};
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    check_refused(context, cscd_object_of_wires(4, 2, beyond), CSCD_INVALID_MESH, "wire 1 names vertex 4");
    check_refused(context, cscd_object_of_wires(4, 2, itself), CSCD_INVALID_MESH, "wire 1 (2 2)");
    check_refused(context, cscd_object_of_wires(4, 0, wires), CSCD_INVALID_MESH, "0 wires");
    check_refused(context, cscd_object_of_wires(4, 2, NULL), CSCD_INVALID_ARGUMENT, "wires is NULL");
    check_refused(context, cscd_object_of_wires(0, 2, wires), CSCD_INVALID_MESH, "0 vertices");
    check_refused(context, cscd_object_of_points(0), CSCD_INVALID_MESH, "0 vertices");
    check_refused(context, half_space_along(0.0, -0.0, 0.0), CSCD_INVALID_MESH, "normal 0");
    check_refused(context, half_space_along(1.0, NAN, 0.0), CSCD_INVALID_MESH, "y = nan");
    check_refused(context, half_space_along(1.0, 0.0, INFINITY), CSCD_INVALID_MESH, "z = inf");
    check_refused(context, half_space_along(0x1p-301, 0.0, 1.0), CSCD_INVALID_MESH, "x = ");
    cscd_object_desc desc = cscd_object_half_space(normal);
    desc.vertex_count = 2;
    check_refused(context, desc, CSCD_INVALID_MESH, "2 vertices");
    desc = cscd_object_of_points(4);
    desc.triangles = tetrahedron;
    check_refused(context, desc, CSCD_INVALID_MESH, "not of triangles");
    desc = cscd_object_of_points(4);
    desc.wire_count = 1;
    check_refused(context, desc, CSCD_INVALID_MESH, "not of wires");
    desc = cscd_object_of_triangles(4, 4, tetrahedron);
    desc.wires = wires;
    check_refused(context, desc, CSCD_INVALID_MESH, "has wires");
    desc.wires = NULL;
    desc.normal[1] = 1.0;
    check_refused(context, desc, CSCD_INVALID_MESH, "has a normal");
    desc = cscd_object_of_points(4);
    desc.normal[2] = 1.0;
    check_refused(context, desc, CSCD_INVALID_MESH, "has a normal");
    desc = cscd_object_of_points(4);
    desc.kind = (cscd_object_kind)4;
    check_refused(context, desc, CSCD_INVALID_ARGUMENT, "unknown kind 4");
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}

/* Counts that no data stand behind do not take memory for seconds. */
TEST(too_many) {
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    cscd_object_desc descs[2] = {cscd_object_of_points((1u << 26) - 1), cscd_object_of_points(2)};
    cscd_mesh *mesh = NULL;
    assert_int_equal(cscd_mesh_create(context, descs, 2, &mesh), CSCD_INVALID_MESH);
    assert_non_null(strstr(cscd_context_detail(context), "points are too many"));
    descs[0] = cscd_object_of_wires(1u << 25, 1, wires);
    assert_int_equal(cscd_mesh_create(context, descs, 2, &mesh), CSCD_INVALID_MESH);
    assert_non_null(strstr(cscd_context_detail(context), "vertices are too many"));
    cscd_context_destroy(context);
}

/* ---- what is of triangles alone --------------------------------------------------------------------------- */

TEST(plans) {
    static const double x[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8};
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    cscd_object_desc descs[2] = {cscd_object_of_triangles(4, 4, tetrahedron),
                                 cscd_object_of_wires(4, 4, wires)};
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    cscd_mesh *mesh = NULL;
    assert_int_equal(cscd_mesh_create(context, descs, 2, &mesh), CSCD_OK);
    for (int method = CSCD_METHOD_SINGLE; method <= CSCD_METHOD_KMEANS; method++) {
        options.method = (cscd_method)method;
        options.k = 1;
        assert_int_equal(cscd_plan_create(context, mesh, CSCD_DOUBLES(x, 8), &options, &plan), CSCD_OK);
        cscd_detector *detector = NULL;
        assert_int_equal(cscd_detector_create(context, mesh, plan, NULL, &detector), CSCD_OK);
        cscd_detector_destroy(detector);
        cscd_plan_destroy(plan);
    }
    cscd_mesh_destroy(mesh);
    assert_int_equal(cscd_mesh_create(context, descs + 1, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_plan_create(context, mesh, CSCD_DOUBLES(x, 4), NULL, &plan), CSCD_INVALID_MESH);
    assert_non_null(strstr(cscd_context_detail(context), "no triangles"));
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}

/* ---- a new mesh from an old one --------------------------------------------------------------------------- */

/* What is put together is what its descriptions make, points behind the edges and wires at vertices included. */
TEST(changed_mesh) {
    cscd_object_desc descs[MIXED], now[MIXED];
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    cscd_mesh *mesh = NULL, *fresh = NULL;
    cscd_mesh_change *change = NULL;
    describe_mixed(descs);
    assert_int_equal(cscd_mesh_create(context, descs, MIXED, &mesh), CSCD_OK);
    const cscd_object_desc four = cscd_object_of_wires(4, 3, wires), points = cscd_object_of_points(3);
    const cscd_object_change changes[3] = {
        {.object = 4, .desc = &four}, {.object = 0}, {.object = UINT32_MAX, .desc = &points}};
    assert_int_equal(cscd_mesh_change_create(context, mesh, changes, 3, &change), CSCD_OK);
    for (int i = 0; i < 3; i++) now[i] = descs[i + 1];
    now[3] = four;
    now[4] = descs[5];
    now[5] = points;
    assert_int_equal(cscd_mesh_create(context, now, 6, &fresh), CSCD_OK);
    const cscd_mesh *joined = cscd_mesh_change_mesh(change);
    assert_true(cscd_mesh_hash(joined) == cscd_mesh_hash(fresh));
    assert_null(mesh_validate(joined));
    assert_null(mesh_validate(fresh));
    assert_int_equal(joined->edge_count, fresh->edge_count);
    assert_memory_equal(joined->edges, fresh->edges, (joined->edge_count + 6) * sizeof *joined->edges);
    assert_memory_equal(joined->loose.wire_stars, fresh->loose.wire_stars, 10 * sizeof(uint32_t));
    assert_memory_equal(joined->loose.wire_star_offsets, fresh->loose.wire_star_offsets,
                        joined->vertex_count * sizeof(uint32_t));
    assert_memory_equal(joined->loose.normals, fresh->loose.normals, 6 * sizeof(double[3]));
    cscd_mesh_change_destroy(change);
    cscd_mesh_destroy(mesh);
    cscd_mesh_destroy(fresh);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}
