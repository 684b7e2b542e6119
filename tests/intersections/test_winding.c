/* Winding numbers on grids where everything degenerates: those of a ray in another direction, with every point written out
 * as a polynomial. */
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/intersections/grid_scene.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { GRIDS = NIGHTLY(8, 20) };

enum { OBJECTS_MAX = 4 };

typedef struct tally_rig {
    int32_t numbers[OBJECTS_MAX];
    bool is_touched[OBJECTS_MAX];
    uint32_t touched[OBJECTS_MAX];
} tally_rig;

static winding_tally tally_of(tally_rig *r) {
    memset(r, 0, sizeof *r);
    return (winding_tally){r->numbers, r->is_touched, r->touched, 0};
}

static int compare_corner(const grid_scene *s, const bvh *hierarchy, corner_side at) {
    tally_rig memory;
    winding_tally tally = tally_of(&memory);
    int largest = 0;
    winding_find(&s->surface, hierarchy, at, &tally);
    for (uint32_t object = 0; object < s->object_count; object++) {
        int truth = winding_oracle_number(s, at, object);
        assert_int_equal(tally.numbers[object], truth);
        if (abs(truth) > largest) largest = abs(truth);
    }
    winding_tally_clear(&tally);
    for (uint32_t object = 0; object < s->object_count; object++) assert_int_equal(memory.numbers[object], 0);
    return largest;
}

TEST(numbers_are_those_of_polynomials) {
    const grid_family families[] = {GRID_TWO_TETRAHEDRA, GRID_BOX_AND_OCTAHEDRON, GRID_PILLOW,
                                    GRID_OCTAHEDRON, GRID_TORUS};
    int wound = 0, twice = 0;
    for (uint64_t seed = 0; seed < 5 * GRIDS; seed++) {
        grid_scene s;
        bvh hierarchy;
        grid_scene_make(families[seed % 5], 1000 + seed, &s);
        mesh_trees_build(s.mesh, s.positions, seed % 3 == 0 ? KDOP_AXES : BOX_AXES, &hierarchy);
        for (uint32_t i = 0; i < s.mesh->triangle_count * 6; i++) {
            int number =
                compare_corner(&s, &hierarchy, (corner_side){i / 6, (uint8_t)(i % 3), i / 3 % 2 == 0});
            wound += number > 0;
            twice += number > 1;
        }
        bvh_free(&hierarchy);
        grid_scene_free(&s);
    }
    print_message("  %d points are wound around, %d of them more than once\n", wound, twice);
    assert_true(wound > 20 * GRIDS && twice > GRIDS);
}
