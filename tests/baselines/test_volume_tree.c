/* The binary trees of the thesis: one triangle a leaf, halves of the longest axis, volumes that hold the motion, flags, sealed nodes. */
#include "runtime/baselines/volume_tree.h"
#include "runtime/bvh/bvh.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene s; /* large; one test at a time */
static rig r;
static volume_tree tree;
static uint32_t regions[SCENE_TRIANGLES_MAX];

/* Triangles go to regions by turns. */
static void open_tree(scene_family family, uint32_t seed, uint32_t region_count) {
    scene_make(family, seed, &s);
    r = rig_create(&s, 1, NULL);
    for (uint32_t t = 0; t < s.triangle_count; t++) regions[t] = t % region_count;
    expect_ok(volume_tree_build(r.mesh, s.x0, regions, region_count, &tree));
}

static void close_tree(void) {
    volume_tree_free(&tree);
    rig_destroy(&r);
}

/* Marks the triangles below a node; returns its last node. */
static uint32_t visit_below(uint32_t node, uint32_t region, bool *seen) {
    const volume_node *n = &tree.nodes[node];
    assert_int_equal(n->region, region);
    if (n->second == 0) {
        assert_false(seen[n->triangle]);
        seen[n->triangle] = true;
        assert_int_equal(regions[n->triangle], region);
        return node;
    }
    const uint32_t last = visit_below(node + 1, region, seen);
    assert_int_equal(n->second, last + 1);
    return visit_below(n->second, region, seen);
}

TEST(each_triangle_is_a_leaf) {
    for (uint32_t count = 1; count < 4; count++) {
        bool seen[SCENE_TRIANGLES_MAX] = {false};
        open_tree(SCENE_SOUP, count, count);
        assert_true(tree.node_count == 2 * s.triangle_count - count && tree.root_count == count);
        for (uint32_t region = 0; region < count; region++) visit_below(tree.roots[region], region, seen);
        for (uint32_t t = 0; t < s.triangle_count; t++) assert_true(seen[t]);
        close_tree();
    }
}

/* Three triangles: x parts the first from the others, but the volume is longest along a diagonal of the cube, which parts the last. */
TEST(the_longest_axis_is_halved) {
    static const double places[3][3] = {{0, 0, 0}, {4, 0, 0}, {3, 3, 3}};
    scene_clear(&s);
    for (uint32_t t = 0; t < 3; t++) {
        for (uint32_t i = 0; i < 3; i++) {
            double *p = s.x0 + s.vertex_count * 3;
            for (int k = 0; k < 3; k++) p[k] = places[t][k] + 0.01 * (i == (uint32_t)k);
            s.triangles[t * 3 + i] = s.vertex_count++;
        }
        s.triangle_count++;
    }
    memcpy(s.x1, s.x0, sizeof s.x0);
    r = rig_create(&s, 1, NULL);
    memset(regions, 0, sizeof regions);
    expect_ok(volume_tree_build(r.mesh, s.x0, regions, 1, &tree));
    const volume_node *second = &tree.nodes[tree.nodes[0].second];
    assert_true(second->second == 0 && second->triangle == 2);
    close_tree();
}

/* Triangles with one centroid, which no middle parts, are halved by number. */
TEST(equal_centroids_are_halved_by_number) {
    scene_clear(&s);
    for (uint32_t t = 0; t < 9; t++) {
        for (uint32_t i = 0; i < 3; i++) {
            s.x0[s.vertex_count * 3] = i == 0 ? 2.0 : -1.0;
            s.x0[s.vertex_count * 3 + 1] = i == 0 ? 0.0 : i == 1 ? 1.0 : -1.0;
            s.triangles[t * 3 + i] = s.vertex_count++;
        }
        s.triangle_count++;
    }
    memcpy(s.x1, s.x0, sizeof s.x0);
    r = rig_create(&s, 1, NULL);
    memset(regions, 0, sizeof regions);
    expect_ok(volume_tree_build(r.mesh, s.x0, regions, 1, &tree));
    assert_true(tree.depth == 5 && tree.node_count == 17);
    close_tree();
}

/* All pairs that share a vertex, and so overlap, by all kinds; and no pair twice. */
TEST(no_overlapping_pair_is_missed) {
    static const volume_kind kinds[] = {VOLUME_SPHERE, VOLUME_BOX, VOLUME_KDOP14};
    for (uint32_t seed = 0; seed < 6; seed++) {
        open_tree(seed % 2 ? SCENE_SOUP : SCENE_BENT_CAPSULE, seed, 1 + seed % 3);
        volume_search found;
        expect_ok(volume_search_open(&tree, &found));
        bool *listed = calloc((size_t)s.triangle_count * s.triangle_count, sizeof *listed);
        bool all[3] = {true, true, true};
        found.keeps_adjacent = all;
        for (int i = 0; i < 3; i++) {
            memset(listed, 0, (size_t)s.triangle_count * s.triangle_count);
            volume_kernels_of(r.context)->refit(&tree, kinds[i], s.x0, s.x1);
            volume_kernels_of(r.context)->search(&tree, kinds[i], &found);
            for (size_t j = 0; j < found.count; j++) {
                bool *place = &listed[found.pairs[j][0] * s.triangle_count + found.pairs[j][1]];
                assert_false(*place);
                *place = true;
            }
            for (uint32_t v = 0; v < s.vertex_count; v++) { /* triangles at a vertex overlap there */
                const uint32_t *star = r.mesh->vertex_stars + r.mesh->vertex_star_offsets[v];
                const uint32_t count = r.mesh->vertex_star_offsets[v + 1] - r.mesh->vertex_star_offsets[v];
                for (uint32_t a = 0; a < count; a++)
                    for (uint32_t b = a + 1; b < count; b++)
                        assert_true(listed[star[a] * s.triangle_count + star[b]]);
            }
        }
        free(listed);
        volume_search_close(&found);
        close_tree();
    }
}

/* Pairs of one region are left out where both have the one sign; sealed nodes leave out the pairs below them. */
TEST(flags_and_seals_leave_out_pairs) {
    static uint8_t orientations[SCENE_TRIANGLES_MAX];
    bool all[2] = {true, true};
    volume_search found;
    open_tree(SCENE_BENT_CAPSULE, 1, 2);
    expect_ok(volume_search_open(&tree, &found));
    found.keeps_adjacent = all;
    for (uint32_t t = 0; t < s.triangle_count; t++)
        orientations[t] = t % 7 == 0 ? ORIENTATION_ZERO : t % 5 == 0 ? ORIENTATION_MINUS : ORIENTATION_PLUS;
    volume_tree_orient(&tree, orientations);
    volume_kernels_of(r.context)->refit(&tree, VOLUME_KDOP14, s.x0, s.x1);
    volume_kernels_of(r.context)->search(&tree, VOLUME_KDOP14, &found);
    size_t kept = found.count, left = 0;
    for (size_t i = 0; i < found.count; i++) {
        const uint32_t a = found.pairs[i][0], b = found.pairs[i][1];
        assert_true(regions[a] != regions[b] || orientations_may_touch(orientations[a], orientations[b]));
    }
    volume_tree_orient(&tree, NULL);
    volume_kernels_of(r.context)->search(&tree, VOLUME_KDOP14, &found);
    for (size_t i = 0; i < found.count; i++) {
        const uint32_t a = found.pairs[i][0], b = found.pairs[i][1];
        left += regions[a] == regions[b] && !orientations_may_touch(orientations[a], orientations[b]);
    }
    assert_true(left > 0 && kept + left == found.count);
    tree.nodes[tree.roots[0]].sealed = true;
    size_t others = 0;
    for (size_t i = 0; i < found.count; i++)
        others += regions[found.pairs[i][0]] != 0 || regions[found.pairs[i][1]] != 0;
    volume_kernels_of(r.context)->search(&tree, VOLUME_KDOP14, &found);
    assert_int_equal(found.count, others);
    volume_search_close(&found);
    close_tree();
}
