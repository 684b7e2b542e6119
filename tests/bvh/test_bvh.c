/* The BVH has a place for each triangle and vertex, and every bound holds what is below it. */
#include "runtime/bvh/bvh.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static scene shape, moved; /* large; one test at a time */

static const uint32_t region_counts[] = {1, 0, 7, 100};
static const int axis_counts[] = {BOX_AXES, KDOP_AXES};
enum { REGION_CHOICES = sizeof region_counts / sizeof *region_counts };

/* The block of a child of a level, and its lane there. */
typedef struct child_place {
    uint32_t block, lane;
} child_place;

static child_place places[BVH_LEVEL_MAX][SCENE_TRIANGLES_MAX];

static uint32_t child_count(const bvh *hierarchy, int level) {
    if (level == 0) return hierarchy->leaf_count;
    return level == hierarchy->tree_level ? hierarchy->tree_count : hierarchy->levels[level - 1].block_count;
}

/* Finds the places and checks that each child has only one. */
static void find_places(const bvh *hierarchy) {
    for (int level = 0; level < hierarchy->level_count; level++) {
        const bvh_level *l = &hierarchy->levels[level];
        memset(places[level], 0xff, sizeof places[level]);
        for (uint32_t b = 0; b < l->block_count; b++) {
            for (uint32_t lane = 0; lane < LANES; lane++) {
                uint32_t child = l->first_children[b] + lane;
                if ((l->flags[b].used >> lane & 1) == 0) continue;
                assert_true(child < child_count(hierarchy, level));
                assert_int_equal(places[level][child].block, UINT32_MAX);
                places[level][child] = (child_place){b, lane};
            }
        }
        for (uint32_t c = 0; c < child_count(hierarchy, level); c++)
            assert_int_not_equal(places[level][c].block, UINT32_MAX);
    }
    assert_int_equal(hierarchy->levels[hierarchy->level_count - 1].block_count, 1);
    assert_int_equal(hierarchy->levels[hierarchy->tree_level - 1].block_count, hierarchy->tree_count);
}

/* ---- places of triangles ------------------------------------------------------------------------------- */

static void check_leaf(const bvh_rig *r, uint32_t index, const bvh_tree *p, uint32_t *seen) {
    const bvh *hierarchy = &r->bvh;
    const bvh_leaf *l = &hierarchy->leaves[index];
    assert_ptr_equal(&hierarchy->trees[hierarchy->leaf_trees[index]], p);
    for (uint32_t lane = 0; lane < LANES; lane++) {
        uint32_t t = l->triangles[lane], from = t != UINT32_MAX ? t : l->triangles[0];
        assert_int_equal(hierarchy->leaf_flags[index].used >> lane & 1, t != UINT32_MAX);
        for (int i = 0; i < 3; i++) {
            uint32_t record = l->corners[i][lane];
            assert_true(record - p->first_record < p->record_count);
            assert_int_equal(hierarchy->record_vertices[record], r->mesh->triangles[from][i]);
        }
        if (t == UINT32_MAX) continue;
        assert_int_equal(r->regions[t], p->region);
        assert_int_equal(hierarchy->slots[t], index * LANES + lane);
        assert_int_equal(bvh_triangle(hierarchy, hierarchy->slots[t]), t);
        seen[t]++;
    }
}

static void check_layout(const bvh_rig *r) {
    static uint32_t seen[SCENE_TRIANGLES_MAX];
    const bvh *hierarchy = &r->bvh;
    uint32_t leaf = 0, record = 0;
    memset(seen, 0, sizeof seen);
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        const bvh_tree *p = &hierarchy->trees[i];
        assert_int_equal(p->first_leaf, leaf);
        assert_int_equal(p->first_record, record);
        assert_int_equal(p->record_count % LANES, 0);
        for (; leaf < p->first_leaf + p->leaf_count; leaf++) {
            check_leaf(r, leaf, p, seen);
            assert_int_equal(hierarchy->block_trees[places[0][leaf].block], i);
        }
        record += p->record_count;
    }
    assert_int_equal(leaf, hierarchy->leaf_count);
    assert_int_equal(record, hierarchy->record_count);
    for (uint32_t t = 0; t < r->mesh->triangle_count; t++) assert_int_equal(seen[t], 1);
}

TEST(every_triangle_has_one_slot) {
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 11, &shape);
        for (int i = 0; i < REGION_CHOICES; i++) {
            bvh_rig r;
            assert_true(
                bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 1, BOX_AXES, region_counts[i]}, &r));
            find_places(&r.bvh);
            check_layout(&r);
            bvh_rig_destroy(&r);
        }
    }
}

/* ---- bounds -------------------------------------------------------------------------------------------- */

static const float *bounds_of(const bvh *hierarchy, int level, child_place at, int axis) {
    size_t stride = (size_t)hierarchy->axis_count * 2 * LANES;
    return hierarchy->levels[level].bounds + at.block * stride + (size_t)axis * 2 * LANES + at.lane;
}

/* The levels of trees and above have no bounds when there is only one tree. */
static int bounded_levels(const bvh *hierarchy) {
    return hierarchy->tree_count > 1 ? hierarchy->level_count : hierarchy->tree_level;
}

/* Checks that all bounds above a triangle hold its vertex and everything within half the distance of it. */
static void check_held(const bvh *hierarchy, uint32_t leaf, gap_motion m, uint32_t vertex, double distance) {
    const bvh_tree *p = &hierarchy->trees[hierarchy->leaf_trees[leaf]];
    for (int moment = 0; moment < 3; moment++) {
        long double own[3], common[3];
        in_frame(hierarchy, p, m, vertex, moment, own);
        in_frame(hierarchy, NULL, m, vertex, moment, common);
        uint32_t child = leaf;
        for (int level = 0; level < bounded_levels(hierarchy); level++) {
            child_place at = places[level][child];
            for (int axis = 0; axis < hierarchy->axis_count; axis++) {
                long double wide =
                    (axis < BOX_AXES ? 0.5L : 0.5L * sqrtl(3.0L)) * distance * hierarchy->scale;
                long double value = along_direction(level < hierarchy->tree_level ? own : common, axis);
                const float *low = bounds_of(hierarchy, level, at, axis);
                assert_true((long double)low[0] <= value - wide);
                assert_true((long double)low[LANES] >= value + wide);
            }
            child = at.block;
        }
    }
}

/* Checks that the bounds of a leaf are no wider than documented. */
static void check_leaf_tight(const bvh *hierarchy, uint32_t leaf, gap_motion m) {
    const bvh_tree *p = &hierarchy->trees[hierarchy->leaf_trees[leaf]];
    for (int axis = 0; axis < hierarchy->axis_count; axis++) {
        long double least = INFINITY, greatest = -INFINITY;
        for (int i = 0; i < 6 * LANES; i++) {
            long double own[3];
            uint32_t record = hierarchy->leaves[leaf].corners[i % 3][i / 6];
            in_frame(hierarchy, p, m, hierarchy->record_vertices[record], i % 6 < 3 ? 0 : 2, own);
            least = fminl(least, along_direction(own, axis));
            greatest = fmaxl(greatest, along_direction(own, axis));
        }
        const float *low = bounds_of(hierarchy, 0, places[0][leaf], axis);
        long double slack = 2.0L * p->slack[axis < BOX_AXES ? 0 : 1];
        assert_true((long double)low[0] >= least - slack);
        assert_true((long double)low[LANES] <= greatest + slack);
    }
}

/* Checks that bounds above the leaves are the union of those below. */
static void check_union(const bvh *hierarchy, int level, uint32_t child) {
    const lane_flags flags = hierarchy->levels[level - 1].flags[child];
    for (int axis = 0; axis < hierarchy->axis_count; axis++) {
        float least = INFINITY, greatest = -INFINITY;
        for (uint32_t lane = 0; lane < LANES; lane++) {
            const float *low = bounds_of(hierarchy, level - 1, (child_place){child, lane}, axis);
            bool used = (flags.used >> lane & 1) != 0;
            if (!used) assert_true(low[0] > low[LANES]);
            least = used ? fminf(least, low[0]) : least;
            greatest = used ? fmaxf(greatest, low[LANES]) : greatest;
        }
        if (level == hierarchy->tree_level) continue;
        const float *low = bounds_of(hierarchy, level, places[level][child], axis);
        assert_true(low[0] == least && low[LANES] == greatest);
    }
}

static void check_bounds(const bvh *hierarchy, gap_motion m, double distance) {
    for (uint32_t leaf = 0; leaf < hierarchy->leaf_count; leaf++) {
        for (int i = 0; i < 3 * LANES; i++) {
            uint32_t record = hierarchy->leaves[leaf].corners[i % 3][i / 3];
            check_held(hierarchy, leaf, m, hierarchy->record_vertices[record], distance);
        }
        check_leaf_tight(hierarchy, leaf, m);
    }
    for (int level = 1; level < bounded_levels(hierarchy); level++) {
        for (uint32_t child = 0; child < child_count(hierarchy, level); child++)
            check_union(hierarchy, level, child);
    }
}

static void scale_scene(const scene *from, int exponent, scene *out) {
    *out = *from;
    for (uint32_t i = 0; i < from->vertex_count * 3; i++) {
        out->x0[i] = ldexp(from->x0[i], exponent);
        out->x1[i] = ldexp(from->x1[i], exponent);
    }
}

static void check_scene(const scene *s, int axis_count, uint32_t region_count, double distance) {
    bvh_rig r;
    assert_true(bvh_rig_create(s, (bvh_setup){CSCD_SIMD_AUTO, 1, axis_count, region_count}, &r));
    find_places(&r.bvh);
    bvh_refit(&r.bvh, s->x0, s->x1, uniform_growth(distance));
    check_bounds(&r.bvh, (gap_motion){s->x0, s->x1}, distance);
    bvh_refit(&r.bvh, s->x1, s->x1, uniform_growth(0.0));
    check_bounds(&r.bvh, (gap_motion){s->x1, s->x1}, 0.0);
    bvh_rig_destroy(&r);
}

TEST(bounds_hold_what_is_below) {
    static const int exponents[] = {-290, -90, 0, 120, 290};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 12, &shape);
        int exponent = exponents[family % 5];
        scale_scene(&shape, exponent, &moved);
        for (int i = 0; i < 2 * REGION_CHOICES; i++)
            check_scene(&moved, axis_counts[i % 2], region_counts[i / 2], 0.0);
        check_scene(&moved, KDOP_AXES, 0, ldexp(0.125, exponent));
        check_scene(&moved, BOX_AXES, 3, ldexp(2.0, exponent));
    }
}

/* Some bodies fly on together, and one stays behind. */
TEST(bounds_of_bodies_that_fly) {
    const double far[3] = {1e3, -3e5, 77.0};
    for (int i = 0; i < 2 * REGION_CHOICES; i++) {
        scene_make(SCENE_LINKED_TORI, 13, &shape);
        translate(shape.x1, shape.vertex_count, far);
        check_scene(&shape, axis_counts[i % 2], region_counts[i / 2], 0.0);
        memcpy(shape.x1, shape.x0, (size_t)shape.vertex_count / 2 * sizeof(double[3]));
        check_scene(&shape, axis_counts[i % 2], region_counts[i / 2], 0.0);
    }
}

/* The scale follows positions that grow or shrink by far, also within one interval. */
TEST(bounds_at_changing_scales) {
    static const int from[] = {0, 290, -290, 290, 10, -40, -40, 0},
                     to[] = {290, -290, 290, 290, 30, -40, 3, 0};
    static scene start, end;
    bvh_rig r;
    scene_make(SCENE_TWO_SPHERES, 14, &shape);
    assert_true(bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 1, KDOP_AXES, 5}, &r));
    find_places(&r.bvh);
    for (size_t i = 0; i < sizeof from / sizeof *from; i++) {
        scale_scene(&shape, from[i], &start);
        scale_scene(&shape, to[i], &end);
        bvh_refit(&r.bvh, start.x0, end.x1, uniform_growth(0.0));
        check_bounds(&r.bvh, (gap_motion){start.x0, end.x1}, 0.0);
    }
    bvh_rig_destroy(&r);
}

/* All vertices lie in one place, at the end or from the start. */
TEST(bounds_of_points) {
    scene_make(SCENE_GRID, 15, &shape);
    for (uint32_t i = 0; i < shape.vertex_count * 3; i++) shape.x0[i] = 0.1 * (i % 3);
    check_scene(&shape, KDOP_AXES, 1, 0.0);
    memcpy(shape.x1, shape.x0, sizeof shape.x1);
    check_scene(&shape, KDOP_AXES, 2, 0.0);
}

/* ---- levels and threads ---------------------------------------------------------------------------------
 */

static void assert_same_bvh(const bvh *a, const bvh *b) {
    assert_memory_equal(a->records, b->records, a->record_count * sizeof *a->records);
    assert_memory_equal(a->leaves, b->leaves, a->leaf_count * sizeof *a->leaves);
    for (int level = 0; level < bounded_levels(a); level++) {
        size_t floats = (size_t)a->levels[level].block_count * (size_t)a->axis_count * 2 * LANES;
        assert_memory_equal(a->levels[level].bounds, b->levels[level].bounds, floats * sizeof(float));
    }
    for (uint32_t i = 0; i < a->tree_count; i++) {
        assert_memory_equal(a->trees[i].weighted, b->trees[i].weighted, sizeof a->trees[i].weighted);
        assert_memory_equal(a->trees[i].slack, b->trees[i].slack, sizeof a->trees[i].slack);
    }
}

TEST(same_on_all_levels_and_threads) {
    for (int i = 0; i < 4; i++) {
        bvh_rig one, other;
        scene_make((scene_family)(i * 3), 16, &shape);
        bvh_setup setup = {CSCD_SIMD_SCALAR, 1, axis_counts[i % 2], region_counts[i]};
        assert_true(bvh_rig_create(&shape, setup, &one));
        bvh_refit(&one.bvh, shape.x0, shape.x1, uniform_growth(0.0));
        for (int simd = CSCD_SIMD_SCALAR; simd <= SIMD_LAST; simd++) {
            setup.simd = (cscd_simd)simd;
            setup.thread_count = (uint32_t)simd;
            if (!bvh_rig_create(&shape, setup, &other)) continue;
            bvh_refit(&other.bvh, shape.x0, shape.x1, uniform_growth(0.0));
            assert_same_bvh(&one.bvh, &other.bvh);
            bvh_rig_destroy(&other);
        }
        bvh_rig_destroy(&one);
    }
}
