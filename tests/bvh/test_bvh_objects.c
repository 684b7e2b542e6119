/* Blocks of many objects: two that are looked at are found, wherever in the blocks they are. */
#include "cscd/cscd.h"
#include "tests/support/packed.h"
#include "tests/support/test.h"

enum { OBJECTS = 100 }; /* besides one; a block has eight children */

static double x0[(OBJECTS + 1) * 9], x1[(OBJECTS + 1) * 9];
static cscd_object_desc objects[OBJECTS + 1];
static cscd_object_rule rules[OBJECTS + 1];

/* Triangles in a row, and a large one that moves through a corner of each. */
static void make_row(void) {
    static const uint32_t triangle[] = {0, 1, 2};
    static const double small[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const double large[9] = {-1, -0.5, -1, 3 * OBJECTS, -0.5, -1, OBJECTS, -0.5, 1e4};
    for (int i = 0; i <= OBJECTS; i++) {
        objects[i] = cscd_object_of_triangles(3, 1, triangle);
        for (int k = 0; k < 9; k++) {
            x0[9 * i + k] = i == OBJECTS ? large[k] : small[k] + (k % 3 == 0 ? 3.0 * i : 0.0);
            x1[9 * i + k] = x0[9 * i + k] + (i == OBJECTS && k % 3 == 1 ? 0.75 : 0.0);
        }
    }
}

TEST(any_two_objects_are_found) {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_contacts found;
    make_row();
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, objects, OBJECTS + 1, &mesh), CSCD_OK);
    assert_int_equal(detector_create_here(mesh, NULL, NULL, &detector), CSCD_OK);
    for (uint32_t chosen = 0; chosen < OBJECTS; chosen++) {
        for (uint32_t i = 0; i <= OBJECTS; i++) {
            const bool looks = i == chosen || i == OBJECTS;
            rules[i] = cscd_object_rule_default();
            rules[i].category = looks ? 2 : 1;
            rules[i].mask = looks ? 2 : 0;
        }
        assert_int_equal(cscd_detector_set_rules(detector, rules, OBJECTS + 1, NULL, 0), CSCD_OK);
        assert_int_equal(step_packed(detector, x0, x1, &found), CSCD_OK);
        assert_true(found.count > 0);
        for (size_t i = 0; i < found.count; i++) {
            const uint32_t *v = found.items[i].vertices;
            assert_true((v[0] / 3 == chosen && v[3] / 3 == OBJECTS) ||
                        (v[0] / 3 == OBJECTS && v[3] / 3 == chosen));
        }
    }
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}
