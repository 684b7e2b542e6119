/* Partitions and sensors of the C++ interface against the functions of C that they stand for. */
#include "tests/cpp/twin_detectors.hpp"

#include <cscd/sensors.hpp>

namespace {

TEST(sensors) {
    const panel_scene scene(10);
    const std::vector<float> x0 = packed(scene.particles), x1 = packed(scene.moved());
    const cscd::context context;
    const cscd::mesh mesh(context, scene.objects());
    cscd::partition_options cells;
    cells.cells = 5;
    cscd::partition partition(context, mesh, x0, cells);
    const cscd_partition *c = partition.get();
    assert_int_equal(partition.object_count(), 2);
    assert_int_equal(partition.part_count(), cscd_partition_part_count(c));
    assert_int_equal(partition.cell_count(), cscd_partition_cell_count(c));
    assert_true(partition.cell_count() >= 10);
    assert_int_equal(partition.part(1).object, 1);
    assert_int_equal(partition.vertex_cell(7), cscd_partition_vertex_cell(c, 7));
    assert_true(partition.distortion(0) == cscd_partition_distortion(c, 0) && partition.distortion(0) > 0.0);

    cscd::sensor_options options;
    options.collision_distance = 2.5;
    cscd::sensors particles(context, mesh, partition, options);
    const cscd::warnings found = particles.step(x0, x1);
    assert_int_equal(found.size(), 1);
    assert_true(found[0].contact && found[0].toi > 0.0);
    assert_false(particles.apart(0, 1));
    assert_int_equal(particles.renewal(0), cscd_sensors_renewal(particles.get(), 0));
    assert_int_equal(particles.particle_count(), partition.cell_count());
    assert_int_equal(particles.particle(3), cscd_sensors_particle(particles.get(), 3));
    assert_true(particles.counters().tests > 0 && particles.timings().total_ms > 0.0);
    partition.renew(x1);
    assert_int_equal(particles.step(x0, x1).size(), 1);
    const std::vector<float> none;
    assert_int_equal(error_of([&] { partition.renew(none); }).status(), CSCD_INVALID_ARGUMENT);
}

/* A plan gives the parts. */
TEST(parts_of_plans) {
    const cscd::context context;
    const cscd::mesh mesh(context, {cscd::object_of_triangles(8, body_triangles)});
    cscd::partition partition(context, mesh, cscd::plan(context, mesh, body_positions), body_positions);
    assert_int_equal(partition.part_count(), 2);
}

} // namespace
