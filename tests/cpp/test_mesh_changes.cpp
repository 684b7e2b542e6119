/* Changes of meshes in the C++ interface against the functions of C that they stand for. */
#include "tests/cpp/twin_detectors.hpp"

namespace {

using map = const std::uint32_t *(*)(const cscd_mesh_change *, cscd_element, std::uint32_t *);

void expect_array(cscd::span<const std::uint32_t> found, const cscd_mesh_change *c, map of, cscd_element what,
                  std::size_t count) {
    std::uint32_t expected = 0;
    assert_ptr_equal(found.data(), of(c, what, &expected));
    assert_int_equal(found.size(), expected);
    assert_int_equal(found.size(), count);
}

/* A panel's first triangle comes off, the other panel goes, and a body comes. */
TEST(changes) {
    const panel_scene scene(4);
    const cscd::context context;
    const cscd::mesh old(context, scene.objects());
    std::vector<triple> torn = scene.triangles;
    std::vector<std::uint32_t> vertices(17), triangles(torn.size());
    for (std::uint32_t i = 0; i < 16; i++) vertices[i] = i;
    for (std::uint32_t t = 0; t < triangles.size(); t++) triangles[t] = t;
    vertices[16] = torn[0][1];
    torn[0][1] = 16;

    cscd::object_change tear{0, cscd::object_of_triangles(17, torn), vertices, triangles};
    const cscd::object_change gone{1, std::nullopt, {}, {}};
    const cscd::object_change comes{UINT32_MAX, cscd::object_of_triangles(8, body_triangles), {}, {}};
    const cscd::mesh_change change(context, old, {tear, gone, comes});
    const cscd_mesh_change *c = change.get();
    assert_ptr_equal(change.mesh().get(), cscd_mesh_change_mesh(c));
    assert_int_equal(change.mesh().vertex_count(), 25);
    expect_array(change.vertices(), c, cscd_mesh_change_to_new, CSCD_VERTICES, 32);
    expect_array(change.edges(), c, cscd_mesh_change_to_new, CSCD_EDGES, old.edge_count());
    expect_array(change.triangles(), c, cscd_mesh_change_to_new, CSCD_TRIANGLES, 36);
    expect_array(change.objects(), c, cscd_mesh_change_to_new, CSCD_OBJECTS, 2);
    expect_array(change.components(), c, cscd_mesh_change_to_new, CSCD_COMPONENTS, 2);
    expect_array(change.vertex_origins(), c, cscd_mesh_change_to_old, CSCD_VERTICES, 25);
    expect_array(change.edge_origins(), c, cscd_mesh_change_to_old, CSCD_EDGES, change.mesh().edge_count());
    expect_array(change.triangle_origins(), c, cscd_mesh_change_to_old, CSCD_TRIANGLES, 26);
    expect_array(change.object_origins(), c, cscd_mesh_change_to_old, CSCD_OBJECTS, 2);
    expect_array(change.component_origins(), c, cscd_mesh_change_to_old, CSCD_COMPONENTS,
                 change.mesh().component_count());
    assert_int_equal(change.vertex_origins()[16], scene.triangles[0][1]);

    const std::vector<std::uint32_t> short_list(3);
    tear.vertex_origins = short_list;
    assert_int_equal(error_of([&] { cscd::mesh_change(context, old, {tear}); }).status(),
                     CSCD_INVALID_ARGUMENT);
    const cscd::object_change nothing{7, std::nullopt, {}, {}};
    assert_int_equal(error_of([&] { cscd::mesh_change(context, old, {nothing}); }).status(),
                     CSCD_INVALID_ARGUMENT);
}

/* ---- detectors ------------------------------------------------------------------------------------------- */

/* A detector that goes over to a mesh without the lower panel finds nothing; its clone stays, and finds what it found,
 * also when the first one is gone. `ignore` goes with both. */
TEST(detectors_move) {
    const panel_scene scene(10);
    const std::vector<float> x0 = packed(scene.particles), x1 = packed(scene.moved());
    const std::vector<float> upper0(x0.begin() + 300, x0.end()), upper1(x1.begin() + 300, x1.end());
    cscd::context context;
    const cscd::context other;
    const cscd::mesh mesh(context, scene.objects());
    unsigned asked = 0;
    cscd::detector_options options;
    options.ignore_if = [&](cscd_contact_kind kind, std::uint32_t, std::uint32_t) {
        asked++;
        if (kind == CSCD_CONTACT_TT) throw 5;
        return kind == CSCD_CONTACT_EE;
    };
    auto detector = std::make_unique<cscd::detector>(context, mesh, options);
    const std::size_t count = detector->step(x0, x1).size();
    cscd::detector clone = detector->clone(other);
    const cscd::mesh_change change(context, mesh, {cscd::object_change{0, std::nullopt, {}, {}}});
    detector->change_mesh(change);
    assert_ptr_equal(detector->mesh().get(), change.mesh().get());
    assert_true(detector->step(upper0, upper1).empty());
    detector.reset();
    asked = 0;
    assert_int_equal(clone.step(x0, x1).size(), count);
    assert_true(count > 0 && asked > count);

    /* What the clone's callback throws arrives in the clone's call. */
    std::vector<float> across = x0;
    for (std::size_t i = 302; i < across.size(); i += 3) across[i] -= 2.0f;
    bool arrived = false;
    try {
        clone.check(across);
    } catch (int five) {
        arrived = five == 5;
    }
    assert_true(arrived);
    assert_int_equal(clone.step(x0, x1).size(), count);
}

} // namespace
