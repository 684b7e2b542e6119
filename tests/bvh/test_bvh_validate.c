/* The validator of the BVH finds every kind of planted fault, and no fault in a BVH that was built and
 * refitted. */
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene shape; /* large; one test at a time */
static bvh_rig rig_of_shape;

static const bvh_setup many_trees = {CSCD_SIMD_SCALAR, 1, KDOP_AXES, 20};

static bvh *build_and_refit(bvh_setup setup) {
    assert_true(bvh_rig_create(&shape, setup, &rig_of_shape));
    bvh *hierarchy = &rig_of_shape.bvh;
    assert_null(bvh_validate(hierarchy, false));
    bvh_refit(hierarchy, shape.x0, shape.x1, uniform_growth(0.0));
    return hierarchy;
}

TEST(sound_ones_have_no_fault) {
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint32_t regions = 0; regions < 24; regions += 8) {
            for (int axes = BOX_AXES; axes <= KDOP_AXES; axes += KDOP_AXES - BOX_AXES) {
                scene_make((scene_family)family, 5, &shape);
                bvh *hierarchy = build_and_refit((bvh_setup){CSCD_SIMD_SCALAR, 1, axes, regions});
                assert_null(bvh_validate(hierarchy, true));
                bvh_rig_destroy(&rig_of_shape);
            }
        }
    }
}

/* Trees may be farther apart than floats can say. */
TEST(trees_at_any_distance_have_no_fault) {
    static const int exponents[] = {60, 126, 127, 128, 129, 200, 290};
    for (int i = 0; i < 7 * 3 * 2; i++) {
        double far = ldexp(1.0, exponents[i / 6]), side = i % 2 == 0 ? far : -far;
        scene_clear(&shape);
        for (int k = 0; k < 3; k++) scene_add_sphere(&shape, (double[3]){0, 3.0 * k, 0}, 1.0, 6, 6);
        for (uint32_t v = 0; v < shape.vertex_count; v++) {
            uint32_t sphere = v / (shape.vertex_count / 3), axis = (uint32_t)i / 2 % 3;
            shape.x0[v * 3 + axis] += sphere == 0 ? side : 0.0;
            shape.x1[v * 3 + axis] += sphere == 0 ? side : sphere == 1 ? -side : 0.0;
        }
        for (int axes = BOX_AXES; axes <= KDOP_AXES; axes += KDOP_AXES - BOX_AXES) {
            bvh *hierarchy = build_and_refit((bvh_setup){CSCD_SIMD_SCALAR, 1, axes, 0});
            assert_int_equal(hierarchy->tree_count, 3);
            const char *fault = bvh_validate(hierarchy, true);
            if (fault != NULL) fail_msg("at 2^%d: %s", exponents[i / 6], fault);
            bvh_rig_destroy(&rig_of_shape);
        }
    }
}

/* Plants some bytes in the BVH, expects the validator to find the fault, and restores the bytes. */
static void expect_fault(bvh *hierarchy, void *place, const void *planted, size_t size,
                         const char *expected) {
    void *saved = malloc(size);
    assert_non_null(saved);
    assert_int_not_equal(memcmp(place, planted, size), 0);
    memcpy(saved, place, size);
    memcpy(place, planted, size);
    const char *fault = bvh_validate(hierarchy, true);
    assert_non_null(fault);
    assert_string_equal(fault, expected);
    memcpy(place, saved, size);
    free(saved);
    assert_null(bvh_validate(hierarchy, true));
}

#define PLANT(f, place, value, expected)                                                                     \
    do {                                                                                                     \
        __typeof__(place) planted = (value);                                                                 \
        expect_fault(f, &(place), &planted, sizeof planted, expected);                                       \
    } while (0)

static bvh *many_trees_of_a_sphere(void) {
    scene_clear(&shape);
    scene_add_sphere(&shape, (double[3]){0, 0, 0}, 1.0, 30, 30);
    bvh *hierarchy = build_and_refit(many_trees);
    assert_true(hierarchy->tree_count == 20 && hierarchy->tree_level >= 1 &&
                hierarchy->level_count > hierarchy->tree_level + 1);
    return hierarchy;
}

TEST(faults_of_leaves) {
    bvh *hierarchy = many_trees_of_a_sphere();
    PLANT(hierarchy, hierarchy->leaf_flags[0].used, 0xfd, "the lanes of a leaf are no prefix");
    PLANT(hierarchy, hierarchy->leaf_flags[0].used, 0x7f,
          "the lanes of a leaf are not those of its triangles");
    PLANT(hierarchy, hierarchy->leaf_trees[0], 1, "a leaf names another tree than its own");
    PLANT(hierarchy, hierarchy->slots[hierarchy->leaves[0].triangles[3]], 1,
          "slots and leaves are not inverse");
    PLANT(hierarchy, hierarchy->leaves[0].triangles[3], hierarchy->leaves[0].triangles[2],
          "slots and leaves are not inverse");
    PLANT(hierarchy, hierarchy->leaves[0].corners[1][3], hierarchy->trees[1].first_record,
          "a corner is a record of another tree");
    PLANT(hierarchy, hierarchy->leaves[0].corners[1][3], hierarchy->leaves[0].corners[0][3],
          "a corner is a record of another vertex");
    PLANT(hierarchy, hierarchy->trees[1].first_leaf, hierarchy->trees[1].first_leaf + 1,
          "the leaves of a tree do not follow the last tree's");
    PLANT(hierarchy, hierarchy->trees[1].first_record, hierarchy->trees[1].first_record + 8,
          "the records of a tree do not follow the last tree's");
    PLANT(hierarchy, hierarchy->leaf_count, hierarchy->leaf_count + 1,
          "some leaves or records are of no tree");
    bvh_rig_destroy(&rig_of_shape);
}

TEST(faults_of_levels) {
    bvh *hierarchy = many_trees_of_a_sphere();
    bvh_level *low = &hierarchy->levels[0], *trees = &hierarchy->levels[hierarchy->tree_level];
    PLANT(hierarchy, low->flags[0].used, 0x5, "the lanes of a block are no prefix");
    PLANT(hierarchy, low->first_children[1], low->first_children[1] + 1,
          "the children of a level do not follow each other");
    PLANT(hierarchy, trees->flags[2].used, 0x7, "a level has not every child once");
    PLANT(hierarchy, hierarchy->trees[1].first_blocks[1], hierarchy->trees[2].first_blocks[1],
          "the blocks of a tree do not lie together");
    PLANT(hierarchy, hierarchy->block_trees[0], 1, "a block names another tree than its own");
    bvh_rig_destroy(&rig_of_shape);
}

/* Plants faults on every level: in both bounds of a used lane along an axis and a diagonal, and in an
 * empty lane. */
TEST(faults_of_bounds) {
    bvh *hierarchy = many_trees_of_a_sphere();
    static const int axes[] = {1, 5};
    for (int level = 0; level < hierarchy->level_count; level++) {
        for (int i = 0; i < 2; i++) {
            float *low = hierarchy->levels[level].bounds + axes[i] * 2 * LANES, *high = low + LANES;
            PLANT(hierarchy, low[0], 0.5f * (low[0] + high[0]), "bounds do not hold what is below");
            PLANT(hierarchy, high[0], 0.5f * (low[0] + high[0]), "bounds do not hold what is below");
        }
    }
    float *last = hierarchy->levels[hierarchy->level_count - 1].bounds + LANES - 1;
    assert_true((hierarchy->levels[hierarchy->level_count - 1].flags[0].used >> (LANES - 1) & 1) == 0);
    PLANT(hierarchy, last[0], last[LANES], "the bounds of an empty lane are not empty");
    bvh_rig_destroy(&rig_of_shape);
}

/* One tree over two components becomes a fault when one of them is declared an obstacle afterwards. */
TEST(obstacles_have_trees_of_their_own) {
    bool obstacles[2] = {false, true};
    scene_clear(&shape);
    for (int i = 0; i < 2; i++) scene_add_sphere(&shape, (double[3]){3.0 * i, 0, 0}, 1.0, 8, 8);
    bvh *hierarchy = build_and_refit((bvh_setup){CSCD_SIMD_SCALAR, 1, BOX_AXES, 1});
    assert_null(bvh_validate(hierarchy, true));
    PLANT(hierarchy, rig_of_shape.mesh->obstacles, obstacles, "a tree holds obstacles and other triangles");
    bvh_rig_destroy(&rig_of_shape);
}
