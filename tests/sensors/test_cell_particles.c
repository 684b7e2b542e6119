/* Each cell has one particle: those of new cells begin in the middle, all others stay where they are. */
#include "sensors/placement.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <string.h>

static scene bodies; /* large; one test at a time */

TEST(renewed_cells_begin_in_the_middle) {
    random_seed(1);
    scene_clear(&bodies);
    scene_add_sphere(&bodies, (double[3]){-4.0, 0.0, 0.0}, 1.0, 12, 16);
    scene_add_sphere(&bodies, (double[3]){4.0, 0.0, 0.0}, 1.0, 12, 16);
    rig r = rig_create(&bodies, 1, NULL);
    sensor_partition *partition = hand_partition_create(r.mesh, bodies.x0, NULL, 2, 8);
    particles p = {.context = r.context};
    uint64_t generation = 0;
    uint32_t middles[SCENE_VERTICES_MAX], moved[SCENE_VERTICES_MAX], renewed = 0, kept = 0;
    assert_int_equal(cell_particles_place(&p, partition, &generation, bodies.x0), CSCD_OK);
    assert_int_equal(p.count, partition->cell_count);
    memcpy(middles, p.vertices, p.count * sizeof *middles);
    for (uint32_t c = 0; c < p.count; c++) { /* they walk */
        uint32_t first = partition->cell_vertices[partition->cell_offsets[c]];
        uint32_t last = partition->cell_vertices[partition->cell_offsets[c + 1] - 1];
        moved[c] = p.vertices[c] = first != middles[c] ? first : last;
    }
    partition->part_generations[1] = ++partition->generation;
    assert_int_equal(cell_particles_place(&p, partition, &generation, bodies.x0), CSCD_OK);
    assert_int_equal(generation, partition->generation);
    for (uint32_t c = 0; c < p.count; c++) {
        const bool fresh = partition->cell_parts[c] == 1;
        assert_int_equal(p.vertices[c], fresh ? middles[c] : moved[c]);
        renewed += fresh && moved[c] != middles[c];
        kept += !fresh && moved[c] != middles[c];
    }
    assert_true(renewed > 3 && kept > 3);
    particles_free(&p);
    hand_partition_destroy(partition);
    rig_destroy(&r);
}
