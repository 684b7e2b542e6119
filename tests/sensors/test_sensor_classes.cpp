/* Sensors of the C++ interface against the functions of C that they stand for. */
#include "tests/cpp/twin_detectors.hpp"

#include <cscd/sensors.hpp>

namespace {

TEST(sensors) {
    const panel_scene scene(10);
    const std::vector<float> x0 = packed(scene.particles), x1 = packed(scene.moved());
    const cscd::context context;
    const cscd::mesh mesh(context, scene.objects());
    cscd::sensor_options options;
    options.cells = 5;
    options.collision_distance = 2.5;
    cscd::sensors particles(context, mesh, x0, options);
    const cscd_sensors *c = particles.get();
    assert_int_equal(particles.part_count(), 2);
    assert_int_equal(particles.cell_count(), cscd_sensors_cell_count(c));
    assert_true(particles.cell_count() >= 10);
    assert_int_equal(particles.part(1).object, 1);
    assert_int_equal(particles.vertex_cell(7), cscd_sensors_vertex_cell(c, 7));

    const cscd::warnings found = particles.step(x0, x1);
    assert_int_equal(found.size(), 1);
    assert_true(found[0].contact && found[0].toi > 0.0);
    assert_int_equal(particles.renewal(0), cscd_sensors_renewal(c, 0));
    assert_int_equal(particles.particle_count(), particles.cell_count());
    assert_int_equal(particles.particle(3), cscd_sensors_particle(c, 3));
    assert_true(particles.counters().tests > 0 && particles.timings().total_ms > 0.0);
    particles.renew(x1);
    assert_int_equal(particles.step(x0, x1).size(), 1);
    const std::vector<float> none;
    assert_int_equal(error_of([&] { particles.renew(none); }).status(), CSCD_INVALID_ARGUMENT);
}

/* A plan gives the parts. */
TEST(parts_of_plans) {
    const cscd::context context;
    const cscd::mesh mesh(context, {cscd::object_of_triangles(8, body_triangles)});
    const cscd::sensors particles(context, mesh, cscd::plan(context, mesh, body_positions), body_positions);
    assert_int_equal(particles.part_count(), 2);
}

} // namespace
