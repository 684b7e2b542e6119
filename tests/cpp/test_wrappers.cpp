/* Contexts, meshes, plans and single pairs of the C++ interface against the functions of C that they stand for. */
#include "tests/cpp/twin_detectors.hpp"

namespace {

bool equal(cscd::span<const std::uint32_t> a, const std::uint32_t *b, std::size_t count) {
    return a.size() == count && std::equal(a.begin(), a.end(), b);
}

/* ---- contexts ---------------------------------------------------------------------------------------------- */

TEST(contexts) {
    cscd::context_options options;
    options.thread_count = 3;
    options.simd = CSCD_SIMD_SCALAR;
    cscd::context context(options);
    assert_true(static_cast<bool>(context));
    assert_int_equal(context.info().thread_count, 3);
    assert_int_equal(context.info().simd, CSCD_SIMD_SCALAR);
    assert_int_equal(context.info().bytes, cscd_context_describe(context.get()).bytes);
    assert_true(context.info().bytes > 0);
    assert_true(context.memory_share() > 0);
    context.cancel();
    cscd::context taken(std::move(context));
    assert_false(static_cast<bool>(context));
    assert_null(context.get());
    context = std::move(taken);
    assert_int_equal(context.info().thread_count, 3);

    options.thread_count = 1000;
    const cscd::error refused = error_of([&] { cscd::context none(options); });
    assert_int_equal(refused.status(), CSCD_INVALID_ARGUMENT);
    assert_string_equal(refused.what(), "thread_count is 1000, expected at most 256");
    options.thread_count = 1;
    options.release = [](void *, std::size_t) {};
    assert_int_equal(error_of([&] { cscd::context none(options); }).status(), CSCD_INVALID_ARGUMENT);
}

/* ---- meshes ------------------------------------------------------------------------------------------------ */

void features(const cscd::mesh &mesh) {
    const cscd_mesh *c = mesh.get();
    for (std::uint32_t t = 0; t < mesh.triangle_count(); t++) {
        std::uint32_t vertices[3], edges[3];
        cscd_mesh_triangle(c, t, vertices);
        cscd_mesh_triangle_edges(c, t, edges);
        assert_true(equal(mesh.triangle(t), vertices, 3));
        assert_true(equal(mesh.triangle_edges(t), edges, 3));
        assert_int_equal(mesh.triangle_component(t), cscd_mesh_triangle_component(c, t));
    }
    for (std::uint32_t v = 0; v < mesh.vertex_count(); v++) {
        std::uint32_t count;
        const std::uint32_t *triangles = cscd_mesh_vertex_triangles(c, v, &count);
        assert_true(equal(mesh.vertex_triangles(v), triangles, count));
        assert_int_equal(mesh.vertex_object(v), cscd_mesh_vertex_object(c, v));
    }
    for (std::uint32_t e = 0; e < mesh.edge_count(); e++) {
        std::uint32_t vertices[2], count;
        cscd_mesh_edge(c, e, vertices);
        const std::uint32_t *triangles = cscd_mesh_edge_triangles(c, e, &count);
        assert_true(equal(mesh.edge(e), vertices, 2));
        assert_true(equal(mesh.edge_triangles(e), triangles, count));
    }
}

TEST(meshes) {
    const cscd::context context;
    const cscd::mesh mesh(context, {cscd::object_of_triangles(8, body_triangles),
                                    cscd::obstacle_of_triangles(8, body_triangles)});
    const cscd_mesh *c = mesh.get();
    assert_int_equal(mesh.object_count(), 2);
    assert_int_equal(mesh.object(1).first_vertex, 8);
    assert_true(mesh.object(1).obstacle && !mesh.object(0).obstacle);
    assert_int_equal(mesh.vertex_count(), 16);
    assert_int_equal(mesh.triangle_count(), 16);
    assert_int_equal(mesh.edge_count(), 24);
    assert_int_equal(mesh.component_count(), 4);
    assert_int_equal(mesh.component(2).euler_characteristic, 2);
    assert_int_equal(mesh.hash(), cscd_mesh_hash(c));
    assert_true(equal(mesh.all_triangles(), cscd_mesh_array(c, CSCD_TRIANGLE_VERTICES), 48));
    assert_true(equal(mesh.all_edges(), cscd_mesh_array(c, CSCD_EDGE_VERTICES), 48));
    assert_true(equal(mesh.all_triangle_edges(), cscd_mesh_array(c, CSCD_TRIANGLE_EDGES), 48));
    assert_int_equal(cscd::mesh_ref(mesh).vertex_count(), 16);
    features(mesh);
    const cscd_stencil stencil = mesh.stencil(CSCD_CONTACT_VF, 4, 0, 0.25, 0.5);
    assert_true(stencil.vertices[0] == 4 && stencil.weights[3] == -0.5);

    const std::vector<std::uint32_t> odd{0, 1, 2, 3};
    assert_int_equal(error_of([&] { cscd::object_of_triangles(4, odd); }).status(), CSCD_INVALID_ARGUMENT);
    const std::vector<std::uint32_t> beyond{0, 1, 9};
    const cscd::error refused =
        error_of([&] { cscd::mesh none(context, {cscd::object_of_triangles(4, beyond)}); });
    assert_int_equal(refused.status(), CSCD_INVALID_MESH);
    assert_non_null(std::strstr(refused.what(), "9"));
}

/* Wires, points and a half-space are the objects that C makes. */
TEST(loose_objects) {
    const cscd::context context;
    const std::vector<std::array<std::uint32_t, 2>> wires{{0, 1}, {1, 2}};
    const cscd::mesh mesh(context,
                          {cscd::object_of_triangles(8, body_triangles), cscd::object_of_wires(3, wires),
                           cscd::object_of_points(5), cscd::object_half_space({0.0, 0.0, 1.0})});
    assert_int_equal(mesh.object(1).kind, CSCD_OBJECT_WIRES);
    assert_int_equal(mesh.object(2).kind, CSCD_OBJECT_POINTS);
    assert_int_equal(mesh.object(3).kind, CSCD_OBJECT_HALF_SPACE);
    assert_int_equal(mesh.edge_count(), 14);
    assert_int_equal(mesh.vertex_count(), 17);
}

/* ---- plans ------------------------------------------------------------------------------------------------- */

TEST(plans) {
    const cscd::context context;
    const cscd::mesh mesh(context, {cscd::object_of_triangles(8, body_triangles)});
    const cscd::plan plan(context, mesh, body_positions);
    assert_int_equal(plan.method(), CSCD_METHOD_CHARGE);
    assert_int_equal(plan.region_count(), cscd_plan_region_count(plan.get()));
    assert_true(plan.info().charge_kernels == cscd_plan_describe(plan.get()).charge_kernels);
    assert_true(plan.capacitance(0) > 0.0 && plan.triangle_charge(0) > 0.0 && plan.timings().total_ms > 0.0);

    std::vector<std::uint32_t> regions;
    std::vector<double> charges, capacitances;
    std::vector<std::array<double, 3>> points;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); t++) {
        regions.push_back(plan.triangle_region(t));
        charges.push_back(plan.triangle_charge(t));
    }
    for (std::uint32_t r = 0; r < plan.region_count(); r++) {
        const cscd_region region = plan.region(r);
        points.push_back({region.detector_point[0], region.detector_point[1], region.detector_point[2]});
    }
    for (std::uint32_t k = 0; k < mesh.component_count(); k++) capacitances.push_back(plan.capacitance(k));
    cscd::plan_parts parts{plan.method(), regions, points, charges, capacitances};
    const cscd::plan again(context, mesh, body_positions, parts);
    assert_int_equal(again.region_count(), plan.region_count());
    assert_true(again.triangle_charge(3) == plan.triangle_charge(3));
    charges.pop_back();
    parts.charges = charges;
    assert_int_equal(error_of([&] { cscd::plan none(context, mesh, body_positions, parts); }).status(),
                     CSCD_INVALID_ARGUMENT);

    cscd::plan_options options;
    options.method = CSCD_METHOD_KMEANS;
    options.k = 2;
    assert_int_equal(cscd::plan(context, mesh, body_positions, options).method(), CSCD_METHOD_KMEANS);
}

/* ---- single pairs ------------------------------------------------------------------------------------------ */

TEST(pairs) {
    const cscd::context context;
    const std::vector<std::array<double, 3>> x0{{0.2, 0.2, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::vector<std::array<double, 3>> x1 = x0;
    x1[0][2] = -1.0;
    const std::vector<std::array<std::uint32_t, 4>> points{{0, 1, 2, 3}, {0, 3, 1, 2}};
    const cscd_pairs two = cscd::pairs_of(CSCD_CONTACT_VF, 4, points);
    const std::vector<cscd_pair_contact> moving = cscd::step_pairs(context, two, x0, x1);
    assert_int_equal(moving.size(), 2);
    assert_true(moving[0].contact && std::fabs(moving[1].toi - 0.5) < 1e-9);
    assert_false(cscd::check_pairs(context, two, x0)[0].contact);
    assert_true(cscd::check_pairs(context, two, x0, 1.5)[0].contact);
    assert_true(cscd::measure_pairs(context, two, x0, 2.0)[1].distance == 1.0);
    assert_true(cscd::step_pairs(context, cscd::pairs_of(CSCD_CONTACT_EE, 4, {}), x0, x1).empty());
    assert_int_equal(error_of([&] { cscd::measure_pairs(context, two, x0, -1.0); }).status(),
                     CSCD_INVALID_ARGUMENT);
}

/* ---- owners ------------------------------------------------------------------------------------------------ */

static_assert(!std::is_copy_constructible_v<cscd::context> && !std::is_copy_assignable_v<cscd::context>);
static_assert(!std::is_copy_constructible_v<cscd::mesh> && !std::is_copy_constructible_v<cscd::plan>);
static_assert(!std::is_copy_constructible_v<cscd::detector> &&
              !std::is_copy_constructible_v<cscd::line_search>);
static_assert(std::is_nothrow_move_constructible_v<cscd::detector> &&
              std::is_nothrow_destructible_v<cscd::detector>);
static_assert(std::is_nothrow_move_assignable_v<cscd::mesh> &&
              std::is_nothrow_move_constructible_v<cscd::line_search>);

TEST(moved_objects) {
    twins t;
    const std::size_t count = t.compare_steps();
    cscd::detector taken = std::move(t.ours);
    assert_int_equal(taken.step(t.x0, t.x1).size(), count);
    const cscd::error refused = error_of([&] { t.ours.step(t.x0, t.x1); });
    assert_int_equal(refused.status(), CSCD_NULL_OBJECT);
    assert_false(static_cast<bool>(t.ours));
    t.ours = std::move(taken);
    assert_int_equal(t.compare_steps(), count);
    cscd::mesh from = std::move(t.mesh);
    assert_int_equal(error_of([&] { cscd::detector none(t.context, t.mesh); }).status(), CSCD_NULL_OBJECT);
    cscd::context gone = std::move(t.context);
    assert_int_equal(error_of([&] { cscd::detector none(t.context, from); }).status(), CSCD_NULL_OBJECT);
}

} // namespace
