/* <cscd/sensors.h> keeps its numbers as in test_api_frozen.c, and its defaults, which are also frozen. */
#include "cscd/cscd.h"
#include "tests/support/test.h"

#define VALUE(name, value) _Static_assert((int)(name) == (value), #name)

VALUE(CSCD_SENSORS_CELLS, 0);
VALUE(CSCD_SENSORS_RANDOM, 1);

VALUE(CSCD_RENEWAL_NONE, 0);
VALUE(CSCD_RENEWAL_AREA, 1);
VALUE(CSCD_RENEWAL_EDGE, 2);
VALUE(CSCD_RENEWAL_CONCAVE, 3);

#if defined(__LP64__) && (defined(__x86_64__) || defined(__aarch64__))

#define SIZE(type, size)            _Static_assert(sizeof(type) == (size), #type)
#define PLACE(type, member, offset) _Static_assert(offsetof(type, member) == (offset), #type "." #member)

SIZE(cscd_partition_options, 40);
PLACE(cscd_partition_options, struct_size, 0);
PLACE(cscd_partition_options, cells, 4);
PLACE(cscd_partition_options, cells_max, 8);
PLACE(cscd_partition_options, normal_weight, 16);
PLACE(cscd_partition_options, epsilon, 24);
PLACE(cscd_partition_options, within, 32);

SIZE(cscd_part, 32);
PLACE(cscd_part, object, 0);
PLACE(cscd_part, first_cell, 4);
PLACE(cscd_part, cell_count, 8);
PLACE(cscd_part, radius, 16);
PLACE(cscd_part, convex, 24);

SIZE(cscd_sensor_options, 48);
PLACE(cscd_sensor_options, struct_size, 0);
PLACE(cscd_sensor_options, method, 4);
PLACE(cscd_sensor_options, collision_distance, 8);
PLACE(cscd_sensor_options, effective_radius, 16);
PLACE(cscd_sensor_options, step_limit, 24);
PLACE(cscd_sensor_options, exact, 28);
PLACE(cscd_sensor_options, area_factor, 32);
PLACE(cscd_sensor_options, particles, 40);
PLACE(cscd_sensor_options, seed, 44);

SIZE(cscd_warning, 56);
PLACE(cscd_warning, part_a, 0);
PLACE(cscd_warning, part_b, 4);
PLACE(cscd_warning, object_a, 8);
PLACE(cscd_warning, object_b, 12);
PLACE(cscd_warning, vertex_a, 16);
PLACE(cscd_warning, vertex_b, 20);
PLACE(cscd_warning, distance, 24);
PLACE(cscd_warning, time, 32);
PLACE(cscd_warning, contact, 40);
PLACE(cscd_warning, toi, 48);

SIZE(cscd_warnings, 24);
PLACE(cscd_warnings, items, 0);
PLACE(cscd_warnings, count, 8);
PLACE(cscd_warnings, renewals_due, 16);

SIZE(cscd_sensor_timings, 40);
PLACE(cscd_sensor_timings, walk_ms, 0);
PLACE(cscd_sensor_timings, verdict_ms, 8);
PLACE(cscd_sensor_timings, exact_ms, 16);
PLACE(cscd_sensor_timings, renewal_ms, 24);
PLACE(cscd_sensor_timings, total_ms, 32);

SIZE(cscd_sensor_counters, 40);
PLACE(cscd_sensor_counters, rounds, 0);
PLACE(cscd_sensor_counters, cycles, 8);
PLACE(cscd_sensor_counters, vertices, 16);
PLACE(cscd_sensor_counters, particle_pairs, 24);
PLACE(cscd_sensor_counters, tests, 32);

#endif

/* The functions are declared again: other parameters or results would not compile. */

cscd_partition_options cscd_partition_defaults(void);
cscd_status cscd_partition_create(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                                  const cscd_partition_options *options, cscd_partition **out);
void cscd_partition_destroy(cscd_partition *partition);
cscd_status cscd_partition_renew(cscd_partition *partition, const double *positions, uint32_t part);
uint32_t cscd_partition_object_count(const cscd_partition *partition);
uint32_t cscd_partition_part_count(const cscd_partition *partition);
cscd_part cscd_partition_part(const cscd_partition *partition, uint32_t part);
uint32_t cscd_partition_cell_count(const cscd_partition *partition);
uint32_t cscd_partition_vertex_cell(const cscd_partition *partition, uint32_t vertex);
double cscd_partition_distortion(const cscd_partition *partition, uint32_t part);
cscd_sensor_options cscd_sensor_defaults(void);
cscd_status cscd_sensors_create(const cscd_mesh *mesh, cscd_partition *partition,
                                const cscd_sensor_options *options, cscd_sensors **out);
void cscd_sensors_destroy(cscd_sensors *sensors);
cscd_status cscd_sensors_step(cscd_sensors *sensors, const double *start, const double *end,
                              cscd_warnings *out);
cscd_renewal cscd_sensors_renewal(const cscd_sensors *sensors, uint32_t part);
bool cscd_sensors_apart(const cscd_sensors *sensors, uint32_t part_a, uint32_t part_b);
uint32_t cscd_sensors_particle_count(const cscd_sensors *sensors);
uint32_t cscd_sensors_particle(const cscd_sensors *sensors, uint32_t particle);
cscd_sensor_timings cscd_sensors_timings(const cscd_sensors *sensors);
cscd_sensor_counters cscd_sensors_counters(const cscd_sensors *sensors);

static void defaults_are_as_the_header_says(void **state) {
    (void)state;
    cscd_partition_options p = cscd_partition_defaults();
    assert_int_equal(p.struct_size, sizeof p);
    assert_true(p.cells == 0 && p.cells_max == 64 && !p.within);
    assert_true(p.normal_weight == 1.0 && p.epsilon == 1e-3);
    cscd_sensor_options s = cscd_sensor_defaults();
    assert_int_equal(s.struct_size, sizeof s);
    assert_true(s.method == CSCD_SENSORS_CELLS && s.exact);
    assert_true(s.collision_distance == 0.0 && s.effective_radius == 0.0 && s.area_factor == 2.0);
    assert_true(s.step_limit == 256 && s.particles == 5 && s.seed == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_as_the_header_says),
    };
    return cmocka_run_group_tests_name("api_frozen_sensors", tests, NULL, NULL);
}
