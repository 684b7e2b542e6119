/* Whole arrays say what the calls for single features say. */
#include "cscd/cscd.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

static scene interval; /* large; one test at a time */

TEST(arrays_are_those_of_single_calls) {
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 2, &interval);
        rig r = rig_create(&interval, 1, NULL);
        const uint32_t *triangles = cscd_mesh_array(r.mesh, CSCD_TRIANGLE_VERTICES),
                       *edges = cscd_mesh_array(r.mesh, CSCD_EDGE_VERTICES),
                       *triangle_edges = cscd_mesh_array(r.mesh, CSCD_TRIANGLE_EDGES);
        for (uint32_t t = 0; t < cscd_mesh_triangle_count(r.mesh); t++) {
            uint32_t vertices[3], sides[3];
            cscd_mesh_triangle(r.mesh, t, vertices);
            cscd_mesh_triangle_edges(r.mesh, t, sides);
            assert_memory_equal(triangles + 3 * t, vertices, sizeof vertices);
            assert_memory_equal(triangle_edges + 3 * t, sides, sizeof sides);
        }
        for (uint32_t e = 0; e < cscd_mesh_edge_count(r.mesh); e++) {
            uint32_t ends[2];
            cscd_mesh_edge(r.mesh, e, ends);
            assert_memory_equal(edges + 2 * e, ends, sizeof ends);
        }
        rig_destroy(&r);
    }
}
