/* Blocks of many objects: two that are looked at are found, wherever in the blocks they are, a tree keeps the
 * distance of its object, and blocks are collapsed when all trees in them are. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

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

/* A tree must keep the distance of its object, whichever of two has one. */
TEST(a_tree_has_the_distance_of_its_object) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD};
    static const uint32_t triangle[] = {0, 1, 2};
    const double x[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.1, 1, 0, 0.1, 0, 1, 0.1};
    for (int i = 0; i < 4; i++) {
        cscd_context *context;
        cscd_mesh *mesh;
        cscd_detector *detector;
        cscd_contacts found;
        cscd_detector_options options = cscd_detector_defaults();
        cscd_object_rule thick[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
        for (int k = 0; k < 2; k++) objects[k] = cscd_object_of_triangles(3, 1, triangle);
        thick[i % 2].thickness = 0.3; /* a pair keeps the mean of two */
        options.method = method_or_none(methods[i / 2]);
        options.rules = thick;
        options.rule_count = 2;
        assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
        assert_int_equal(cscd_mesh_create(context, objects, 2, &mesh), CSCD_OK);
        assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_OK);
        assert_int_equal(step_packed(detector, x, x, &found), CSCD_OK);
        assert_int_equal(found.count, 15);
        cscd_detector_destroy(detector);
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(context);
    }
}

static bool all_collapsed(const bvh *hierarchy, int level, uint32_t child, const bool *collapsed) {
    if (level == hierarchy->tree_level)
        return collapsed[bvh_tree_component(hierarchy, &hierarchy->trees[child])];
    const bvh_level *below = &hierarchy->levels[level - 1];
    bool all = true;
    for (uint32_t i = 0; i < LANES && (below->flags[child].used >> i & 1) != 0; i++)
        all = all && all_collapsed(hierarchy, level - 1, below->first_children[child] + i, collapsed);
    return all;
}

/* A block is left out as collapsed only if all trees in it are. */
TEST(blocks_are_collapsed_as_a_whole) {
    enum { TRIANGLES = 80 };
    static scene apart;
    static bool collapsed[TRIANGLES];
    bvh_rig r;
    scene_clear(&apart);
    apart.vertex_count = 3 * TRIANGLES;
    apart.triangle_count = TRIANGLES;
    for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
        apart.triangles[i] = i;
        for (uint32_t k = 0; k < 3; k++) apart.x0[3 * i + k] = 3.0 * (i / 3) + (i % 3 == k ? 1.0 : 0.0);
    }
    assert_true(bvh_rig_create(&apart, (bvh_setup){CSCD_SIMD_AUTO, 1, BOX_AXES, 0}, &r));
    assert_int_equal(r.bvh.tree_count, TRIANGLES);
    for (uint32_t t = 0; t <= TRIANGLES; t++) { /* one more after the other, in the order of the leaves */
        assert_true(bvh_mark_collapsed(&r.bvh, collapsed));
        for (int level = r.bvh.tree_level; level < r.bvh.level_count; level++) {
            const bvh_level *at = &r.bvh.levels[level];
            for (uint32_t i = 0; i < at->block_count * LANES; i++) {
                if ((at->flags[i / LANES].used >> i % LANES & 1) == 0) continue;
                const bool all =
                    all_collapsed(&r.bvh, level, at->first_children[i / LANES] + i % LANES, collapsed);
                assert_int_equal(at->collapsed_lanes[i / LANES] >> i % LANES & 1, all);
            }
        }
        if (t < TRIANGLES) collapsed[bvh_tree_component(&r.bvh, &r.bvh.trees[t])] = true;
    }
    bvh_rig_destroy(&r);
}
