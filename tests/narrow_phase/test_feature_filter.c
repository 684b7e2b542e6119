/* The feature_filter against exact gaps: which pairs of features of two triangles it keeps. */
#include "runtime/narrow_phase/narrow_phase_kernels.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { PAIR_COUNT = 1500, LEVELS_MAX = SIMD_LAST };

static scene shape; /* large; one test at a time */
static triangle_pair pairs[PAIR_COUNT];
static uint16_t features[LEVELS_MAX][PAIR_COUNT];
static bvh_rig levels[LEVELS_MAX];
static uint32_t level_count;
static uint64_t kept_count, dropped_count;

/* Levels of vector instructions that the processor has not are left out. */
static void open_levels(uint32_t region_count, double distance) {
    level_count = 0;
    for (int simd = CSCD_SIMD_SCALAR; simd <= SIMD_LAST; simd++) {
        bvh_rig *r = &levels[level_count];
        if (!bvh_rig_create(&shape, (bvh_setup){(cscd_simd)simd, 1, BOX_AXES, region_count}, r)) continue;
        bvh_refit(&r->bvh, shape.x0, shape.x1, uniform_growth(distance));
        level_count++;
    }
}

static void close_levels(void) {
    for (uint32_t i = 0; i < level_count; i++) bvh_rig_destroy(&levels[i]);
}

/* Bit of a feature pair (runtime/narrow_phase/narrow_phase_kernels.h) to the vertices of its two features. */
typedef struct feature_points {
    uint32_t a[3], b[3];
    int count_a, count_b;
} feature_points;

static feature_points points_of(const uint32_t *a, const uint32_t *b, int bit) {
    feature_points out = {{0}, {0}, 1, 3};
    if (bit >= FEATURE_EDGES) {
        int i = (bit - FEATURE_EDGES) / 3, j = (bit - FEATURE_EDGES) % 3;
        return (feature_points){{a[i], a[(i + 1) % 3]}, {b[j], b[(j + 1) % 3]}, 2, 2};
    }
    bool of_b = bit >= FEATURE_VERTEX_B;
    out.a[0] = of_b ? b[bit - FEATURE_VERTEX_B] : a[bit];
    memcpy(out.b, of_b ? a : b, sizeof out.b);
    return out;
}

static bool share_vertex(const feature_points *p) {
    for (int i = 0; i < p->count_a * p->count_b; i++) {
        if (p->a[i % p->count_a] == p->b[i / p->count_a]) return true;
    }
    return false;
}

/* As documented: 48 u of both reaches and of what lies between the trees, along diagonals; as much again is
 * what a gap may be off. */
static long double slack_between(const bvh *hierarchy, triangle_pair pair) {
    const bvh_tree *p = &hierarchy->trees[hierarchy->leaf_trees[pair.a / LANES]];
    const bvh_tree *q = &hierarchy->trees[hierarchy->leaf_trees[pair.b / LANES]];
    long double size = (long double)p->reach + q->reach;
    for (int i = 0; i < 6; i++) {
        double from = p->origin[i / 3][i % 3], to = q->origin[i / 3][i % 3];
        size += (fabs(to - from) + 0x1p-24 * (fabs(from) + fabs(to))) * hierarchy->scale;
    }
    return 0x1p-18L * size / hierarchy->scale;
}

static void check_features(uint32_t i, double distance) {
    const bvh *hierarchy = &levels[0].bvh;
    const uint32_t *a = shape.triangles + (size_t)bvh_triangle(hierarchy, pairs[i].a) * 3;
    const uint32_t *b = shape.triangles + (size_t)bvh_triangle(hierarchy, pairs[i].b) * 3;
    long double slack = slack_between(hierarchy, pairs[i]);
    for (int bit = 0; bit < 15; bit++) {
        bool kept = (features[0][i] >> bit & 1) != 0;
        feature_points p = points_of(a, b, bit);
        if (share_vertex(&p)) {
            assert_false(kept);
            continue;
        }
        long double gap = direction_gap((gap_motion){shape.x0, shape.x1}, (point_set){p.a, p.count_a},
                                        (point_set){p.b, p.count_b}, distance + slack);
        if (gap <= distance) assert_true(kept);
        if (gap > distance + slack) assert_false(kept);
        kept_count += kept;
        dropped_count += !kept;
    }
    assert_int_equal(features[0][i] & ~FEATURE_ALL, 0);
}

static void choose_pairs(random_stream *random) {
    uint32_t n = shape.triangle_count;
    for (uint32_t i = 0; i < PAIR_COUNT; i++) {
        uint32_t a = stream_below(random, n), b = stream_below(random, n - 1);
        if (i % 2 == 0) b = (a + stream_below(random, n < 20 ? n - 1 : 20)) % (n - 1); /* often neighbours */
        b += b >= a;
        pairs[i] = (triangle_pair){levels[0].bvh.slots[a], levels[0].bvh.slots[b]};
    }
}

/* Any number of pairs at a time, and no more of them is written. */
static void feature_filter_in_runs(const bvh *hierarchy, double distance, uint16_t *out) {
    enum { UNWRITTEN = 0xffff };
    uint32_t run = 1;
    for (uint32_t i = 0; i < PAIR_COUNT; i += run, run = run % 20 + 1) {
        uint32_t count = PAIR_COUNT - i < run ? PAIR_COUNT - i : run;
        uint16_t some[32];
        for (uint32_t k = 0; k < 32; k++) some[k] = k < count ? FEATURE_ALL : UNWRITTEN;
        swept_interval interval = {
            .x0 = shape.x0, .x1 = shape.x1, .bvh = hierarchy, .limit = {distance, 0.0}};
        narrow_phase_kernels_of(hierarchy->mesh->context)
            ->feature_filter(&interval, pairs + i, count, false, some);
        for (uint32_t k = count; k < 32; k++) assert_int_equal(some[k], UNWRITTEN);
        memcpy(out + i, some, count * sizeof *some);
    }
}

static void check_scene(random_stream *random, uint32_t region_count, double distance) {
    if (shape.triangle_count < 2) return;
    open_levels(region_count, distance);
    choose_pairs(random);
    for (uint32_t l = 0; l < level_count; l++) {
        const bvh *hierarchy = &levels[l].bvh;
        feature_filter_in_runs(hierarchy, distance, features[l]);
        assert_memory_equal(features[l], features[0], sizeof features[l]);
    }
    for (uint32_t i = 0; i < PAIR_COUNT; i++) check_features(i, distance);
    close_levels();
}

static void scale_shape(int exponent) {
    for (uint32_t i = 0; i < shape.vertex_count * 3; i++) {
        shape.x0[i] = ldexp(shape.x0[i], exponent);
        shape.x1[i] = ldexp(shape.x1[i], exponent);
    }
}

static void check_families(uint64_t seed, const double far[3], int exponent, double distance) {
    random_stream random = stream_start(seed);
    kept_count = dropped_count = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint32_t region_count = 0; region_count < 3; region_count++) {
            scene_make((scene_family)family, seed + region_count, &shape);
            translate(shape.x1, shape.vertex_count, far);
            scale_shape(exponent);
            check_scene(&random, region_count * region_count * 6, ldexp(distance, exponent));
        }
    }
    print_message("kept %llu, dropped %llu\n", (unsigned long long)kept_count,
                  (unsigned long long)dropped_count);
    assert_true(kept_count > 1000 && dropped_count > 1000);
}

static const double nowhere[3] = {0.0, 0.0, 0.0};

TEST(keeps_what_may_touch) {
    check_families(50, nowhere, 0, 0.0);
}

TEST(keeps_what_may_touch_in_flight) {
    const double far[3] = {3000.0, -0.75, -2e5};
    check_families(60, far, 0, 0.0);
}

/* What overlaps by nothing but rounding. */
TEST(keeps_what_just_touches) {
    random_stream random = stream_start(55);
    kept_count = dropped_count = 0;
    for (uint32_t i = 0; i < 24; i++) {
        make_touching_pairs(&random, 100, i % 2 == 0 ? 2.0 : 300.0, &shape);
        open_levels(i / 2 % 4, 0.0);
        uint32_t count = shape.triangle_count / 2;
        for (uint32_t p = 0; p < count; p++) {
            const uint32_t *slots = levels[0].bvh.slots;
            pairs[p] = (triangle_pair){slots[2 * p + i % 2], slots[2 * p + 1 - i % 2]};
        }
        swept_interval interval = {.x0 = shape.x0, .x1 = shape.x1, .bvh = &levels[0].bvh};
        for (uint32_t p = 0; p < count; p++) features[0][p] = FEATURE_ALL;
        narrow_phase_kernels_of(levels[0].bvh.mesh->context)
            ->feature_filter(&interval, pairs, count, false, features[0]);
        for (uint32_t p = 0; p < count; p++) check_features(p, 0.0);
        close_levels();
    }
    print_message("kept %llu, dropped %llu\n", (unsigned long long)kept_count,
                  (unsigned long long)dropped_count);
    assert_true(kept_count > 1000);
}

TEST(keeps_what_comes_within_the_distance) {
    check_families(70, nowhere, 0, 0.1);
}

TEST(keeps_at_any_scale) {
    check_families(80, nowhere, 280, 0.0);
    check_families(90, nowhere, -250, 0.05);
}
