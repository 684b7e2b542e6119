/* Orientation signs are checked by exact arithmetic: one wrong S+ or S- fails. So are the places of
 * detector points. */
#include "runtime/bvh/bvh_parts.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <gmp.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BATCH_COUNT = 12500, BATCH_SIZE = LANES, TRIANGLE_COUNT = BATCH_COUNT * BATCH_SIZE };
enum { UNIT_EXPONENT = -200 };

static scene shape; /* large; one test at a time */

static int seed_random(void **state) {
    (void)state;
    random_seed(41);
    return 0;
}

/* ---- the exact value ---- */

typedef struct exact_vector {
    mpz_t x[3];
} exact_vector;

/* p0 - d, p1 - p0 and p2 - p0 at both ends, in units of 2^UNIT_EXPONENT. */
typedef struct exact_triangle {
    exact_vector c[2], a[2], b[2];
} exact_triangle;

/* out = p - q - r */
static void exact_difference(const double p[3], const double q[3], const double r[3], exact_vector *out) {
    mpz_t other;
    mpz_init(other);
    for (int k = 0; k < 3; k++) {
        mpz_set_d(out->x[k], ldexp(p[k], -UNIT_EXPONENT));
        mpz_set_d(other, ldexp(q[k], -UNIT_EXPONENT));
        mpz_sub(out->x[k], out->x[k], other);
        mpz_set_d(other, ldexp(r[k], -UNIT_EXPONENT));
        mpz_sub(out->x[k], out->x[k], other);
    }
    mpz_clear(other);
}

/* sum += (a x b) . c */
static void add_determinant(const exact_vector *a, const exact_vector *b, const exact_vector *c, mpz_t sum) {
    mpz_t minor;
    mpz_init(minor);
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        mpz_mul(minor, a->x[y], b->x[z]);
        mpz_submul(minor, a->x[z], b->x[y]);
        mpz_addmul(sum, minor, c->x[k]);
    }
    mpz_clear(minor);
}

/* Computes the signs of the four exact Bernstein coefficients of (p0 - d) . n, where d is the tree's
 * detector point. */
static void exact_signs(const double x0[9], const double x1[9], const bvh *hierarchy, int signs[4]) {
    static const double zero[3] = {0.0, 0.0, 0.0};
    const bvh_tree *p = &hierarchy->trees[0];
    static exact_triangle t;
    static bool ready;
    exact_vector *vectors[6] = {&t.c[0], &t.c[1], &t.a[0], &t.a[1], &t.b[0], &t.b[1]};
    for (int i = 0; i < 18 && !ready; i++) mpz_init(vectors[i / 3]->x[i % 3]);
    ready = true;
    for (int end = 0; end < 2; end++) {
        const double *x = end == 0 ? x0 : x1;
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = (double)p->detector[end][k] / hierarchy->scale;
        exact_difference(x, p->origin[end], d, &t.c[end]);
        exact_difference(x + 3, x, zero, &t.a[end]);
        exact_difference(x + 6, x, zero, &t.b[end]);
    }
    mpz_t sum;
    mpz_init(sum);
    for (int ends = 0; ends < 4; ends++) { /* the bits say which of the three vectors are taken at t = 1 */
        mpz_set_ui(sum, 0);
        for (int choice = 0; choice < 8; choice++) {
            int a = choice & 1, b = choice >> 1 & 1, c = choice >> 2;
            if (a + b + c == ends) add_determinant(&t.a[a], &t.b[b], &t.c[c], sum);
        }
        signs[ends] = mpz_sgn(sum);
    }
    mpz_clear(sum);
}

/* ---- triangles ---- */

static float nudged_by(float x) {
    for (int i = random_integer(0, 3); i > 0; i--)
        x = nextafterf(x, random_integer(0, 1) ? INFINITY : -INFINITY);
    return x;
}

static void make_triangles(uint32_t count) {
    scene_clear(&shape);
    shape.vertex_count = count * 3;
    shape.triangle_count = count;
    for (uint32_t i = 0; i < count * 3; i++) shape.triangles[i] = i;
}

static void move_triangles(double offset, double speed) {
    for (uint32_t t = 0; t < shape.triangle_count; t++) {
        int bits = random_integer(0, 3) == 0 ? 3 : 40;
        for (uint32_t i = 9 * t; i < 9 * t + 9; i++) {
            shape.x0[i] = offset + ldexp(rint(ldexp(random_unit(), bits)), -bits);
            shape.x1[i] = shape.x0[i] + speed * random_unit();
        }
    }
}

/* Moves a vertex so that triangle t lies nearly in one plane with the detector point at one end. */
static void put_into_plane(bvh *hierarchy, uint32_t t, int end) {
    const double *x = (end == 0 ? shape.x0 : shape.x1) + (size_t)t * 9;
    double u = 3.0 * random_unit(), v = 3.0 * random_unit();
    bvh_tree *p = &hierarchy->trees[0];
    for (int k = 0; k < 3; k++) {
        double at = x[k] + u * (x[3 + k] - x[k]) + v * (x[6 + k] - x[k]);
        p->detector[end][k] = nudged_by((float)((at - p->origin[end][k]) * hierarchy->scale));
    }
}

static void place_detector(bvh *hierarchy, double speed, bool near_zero) {
    bvh_tree *p = &hierarchy->trees[0];
    for (int k = 0; k < 3; k++) {
        p->detector[0][k] = (float)(2.0 * random_unit() * hierarchy->scale);
        p->detector[1][k] = p->detector[0][k] + (float)(speed * random_unit() * hierarchy->scale);
    }
    if (!near_zero) return;
    uint32_t t = (uint32_t)random_integer(0, BATCH_SIZE - 1);
    int where = random_integer(0, 2); /* at the start, at the end, or at both */
    if (where != 1) put_into_plane(hierarchy, t, 0);
    if (where != 0) put_into_plane(hierarchy, t, 1);
}

/* Creates a BVH for each level of vector instructions that the processor has; returns how many there are. */
static uint32_t open_levels(bvh_rig levels[SIMD_LAST]) {
    uint32_t count = 0;
    for (int simd = CSCD_SIMD_SCALAR; simd <= SIMD_LAST; simd++)
        count += bvh_rig_create(&shape, (bvh_setup){(cscd_simd)simd, 1, BOX_AXES, 1}, &levels[count]);
    return count;
}

static void orient_all(bvh *hierarchy, uint8_t *flags) {
    hierarchy->kernels->orient(hierarchy, &hierarchy->trees[0], 0, hierarchy->leaf_count, NULL, flags);
}

static void check_batch(const bvh *hierarchy, const uint8_t *flags, int count[4], int *lost) {
    for (uint32_t t = 0; t < BATCH_SIZE; t++) {
        int signs[4];
        exact_signs(shape.x0 + (size_t)t * 9, shape.x1 + (size_t)t * 9, hierarchy, signs);
        int sum = signs[0] + signs[1] + signs[2] + signs[3];
        if (flags[t] == ORIENTATION_PLUS) assert_int_equal(sum, 4);
        if (flags[t] == ORIENTATION_MINUS) assert_int_equal(sum, -4);
        count[flags[t]]++;
        *lost += flags[t] == ORIENTATION_ZERO && (sum == 4 || sum == -4);
    }
}

TEST(signs_are_exact) {
    int count[4] = {0}, lost = 0;
    bvh_rig levels[SIMD_LAST];
    make_triangles(BATCH_SIZE);
    uint32_t level_count = open_levels(levels);
    for (int i = 0; i < BATCH_COUNT; i++) {
        double speed = ldexp(1.0, -random_integer(0, 12));
        uint8_t flags[SIMD_LAST][BATCH_SIZE];
        move_triangles(random_integer(0, 1) ? 0.0 : ldexp(random_unit(), random_integer(0, 20)), speed);
        for (uint32_t l = 0; l < level_count; l++) {
            bvh *hierarchy = &levels[l].bvh;
            bvh_refit(hierarchy, shape.x0, shape.x1, uniform_growth(0.0));
            if (l == 0) place_detector(hierarchy, speed, i % 3 == 0);
            memcpy(hierarchy->trees[0].detector, levels[0].bvh.trees[0].detector,
                   sizeof hierarchy->trees[0].detector);
            orient_all(hierarchy, flags[l]);
            assert_memory_equal(flags[l], flags[0], sizeof flags[l]);
        }
        check_batch(&levels[0].bvh, flags[0], count, &lost);
    }
    for (uint32_t l = 0; l < level_count; l++) bvh_rig_destroy(&levels[l]);
    printf("S+ %d, S- %d, S0 %d, of which exact signs would decide %d\n", count[ORIENTATION_PLUS],
           count[ORIENTATION_MINUS], count[ORIENTATION_ZERO], lost);
    assert_true(count[ORIENTATION_PLUS] > 10000 && count[ORIENTATION_MINUS] > 10000);
    assert_true(lost < TRIANGLE_COUNT / 10);
}

static uint8_t orientation_from(bvh *hierarchy, double end_height, const double start[3],
                                const double end[3]) {
    uint8_t flag;
    for (int i = 0; i < 3; i++) shape.x1[3 * i + 2] = end_height;
    bvh_refit(hierarchy, shape.x0, shape.x1, uniform_growth(0.0));
    bvh_tree *p = &hierarchy->trees[0];
    for (int k = 0; k < 3; k++) {
        p->detector[0][k] = (float)((start[k] - p->origin[0][k]) * hierarchy->scale);
        p->detector[1][k] = (float)((end[k] - p->origin[1][k]) * hierarchy->scale);
    }
    orient_all(hierarchy, &flag);
    return flag;
}

TEST(sides_of_a_plane) {
    static const double x[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const double below[2][3] = {{0, 0, -1}, {5, 5, -1}}, above[2][3] = {{0, 0, 1}, {5, 5, 1}};
    static const double within[2][3] = {{7, 7, 0}, {8, 8, 0}};
    bvh_rig r;
    make_triangles(1);
    memcpy(shape.x0, x, sizeof x);
    memcpy(shape.x1, x, sizeof x);
    assert_true(bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 1, BOX_AXES, 1}, &r));
    assert_int_equal(orientation_from(&r.bvh, 0, below[0], below[1]), ORIENTATION_PLUS);
    assert_int_equal(orientation_from(&r.bvh, 0, above[0], above[1]), ORIENTATION_MINUS);
    assert_int_equal(orientation_from(&r.bvh, 0, below[0], above[1]), ORIENTATION_ZERO);
    assert_int_equal(orientation_from(&r.bvh, 0, within[0], within[1]), ORIENTATION_ZERO);
    assert_int_equal(orientation_from(&r.bvh, 3, above[0], above[1]), ORIENTATION_ZERO);
    assert_int_equal(orientation_from(&r.bvh, 3, below[0], below[1]), ORIENTATION_PLUS);
    bvh_rig_destroy(&r);
}

/* ---- detector points ---- */

/* Computes the point as the weighted mean; tests/support/bvh/bvh_rig.h gives all triangles of a region
 * equal weights. */
static void expected_point(const bvh_rig *r, uint32_t region, const double *x, long double out[3]) {
    long double size = 0.0L;
    for (int k = 0; k < 3; k++) out[k] = 0.0L;
    for (uint32_t t = 0; t < r->mesh->triangle_count; t++) {
        if (r->regions[t] != region) continue;
        size += 1.0L;
        for (size_t i = 0; i < 9; i++)
            out[i % 3] += x[(size_t)r->mesh->triangles[t][i / 3] * 3 + i % 3] / 3.0L;
    }
    for (int k = 0; k < 3; k++) out[k] /= size;
}

static void check_points(const bvh_rig *r, const double (*offsets)[3]) {
    const bvh *hierarchy = &r->bvh;
    double extent = motion_extent((gap_motion){shape.x0, shape.x1}, shape.vertex_count);
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        const bvh_tree *p = &hierarchy->trees[i];
        for (int end = 0; end < 2; end++) {
            long double expected[3];
            expected_point(r, p->region, end == 0 ? shape.x0 : shape.x1, expected);
            for (int k = 0; k < 3; k++) {
                long double found = p->origin[end][k] + (long double)p->detector[end][k] / hierarchy->scale;
                long double wanted = expected[k] + offsets[p->region][k];
                assert_true(fabsl(found - wanted) <= 0x1p-20L * extent);
            }
        }
    }
}

TEST(detector_points_follow_their_regions) {
    static uint8_t flags[SCENE_TRIANGLES_MAX];
    scene_make(SCENE_LINKED_TORI, 42, &shape);
    for (uint32_t region_count = 0; region_count < 4; region_count++) {
        bvh_rig r;
        double offsets[4][3];
        bool culled[4] = {true, true, true, true};
        for (int i = 0; i < 12; i++) offsets[i / 3][i % 3] = random_unit();
        assert_true(bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 2, BOX_AXES, region_count}, &r));
        bvh_refit(&r.bvh, shape.x0, shape.x1, uniform_growth(0.0));
        orientation_query view = {.culled = culled, .detector_offsets = (const double(*)[3])offsets};
        bvh_orient(&r.bvh, &view, flags);
        check_points(&r, (const double(*)[3])offsets);
        bvh_rig_destroy(&r);
    }
}

/* ---- flags of leaves and blocks ---- */

static uint8_t orientations[2][SCENE_TRIANGLES_MAX];

/* A sphere seen from its middle: all of its triangles face that, whichever task their leaves are in. */
static void orient_sphere(bvh_rig *r) {
    static const double middle[1][3];
    static const bool culled[1] = {true};
    const orientation_query view = {.culled = culled, .detector_offsets = middle};
    scene_clear(&shape);
    scene_add_sphere(&shape, middle[0], 1.0, 24, 32);
    assert_true(bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 2, BOX_AXES, 1}, r));
    bvh_refit(&r->bvh, shape.x0, shape.x0, uniform_growth(0.0));
    memset(orientations[0], ORIENTATION_ZERO, sizeof orientations[0]);
    bvh_orient(&r->bvh, &view, orientations[0]);
}

/* Returns how many leaves and children of blocks have a flag. */
static uint32_t count_flags(const bvh *hierarchy) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < hierarchy->leaf_count; i++)
        count += (hierarchy->leaf_flags[i].plus | hierarchy->leaf_flags[i].minus |
                  hierarchy->leaf_flags[i].newly_kept) != 0;
    for (int level = 0; level < hierarchy->level_count; level++) {
        for (uint32_t b = 0; b < hierarchy->levels[level].block_count; b++) {
            const lane_flags flags = hierarchy->levels[level].flags[b];
            count += (flags.plus | flags.minus | flags.newly_kept) != 0;
        }
    }
    return count;
}

TEST(all_leaves_are_oriented_and_refits_forget_it) {
    bvh_rig r;
    orient_sphere(&r);
    assert_true(r.bvh.leaf_count > 150); /* several tasks */
    for (uint32_t t = 0; t < shape.triangle_count; t++)
        assert_int_equal(orientations[0][t], ORIENTATION_PLUS);
    assert_true(count_flags(&r.bvh) > r.bvh.leaf_count);
    bvh_refit(&r.bvh, shape.x0, shape.x1, uniform_growth(0.0));
    assert_int_equal(count_flags(&r.bvh), 0);
    bvh_rig_destroy(&r);
}

TEST(what_had_a_sign_and_has_none_is_newly_kept) {
    bvh_rig r;
    orient_sphere(&r);
    const bvh *hierarchy = &r.bvh;
    for (uint32_t t = 0; t < shape.triangle_count; t++) {
        orientations[0][t] = (uint8_t)random_integer(ORIENTATION_ZERO, ORIENTATION_MINUS);
        orientations[1][t] = random_integer(0, 1) == 0 ? orientations[0][t] : ORIENTATION_ZERO;
    }
    bvh_mark_newly_kept(&r.bvh, orientations[0], orientations[1]);
    for (uint32_t i = 0; i < hierarchy->leaf_count; i++) {
        for (uint32_t lane = 0; lane < LANES && (hierarchy->leaf_flags[i].used >> lane & 1) != 0; lane++) {
            const uint32_t t = hierarchy->leaves[i].triangles[lane];
            const bool expected =
                orientations[0][t] != ORIENTATION_ZERO && orientations[1][t] == ORIENTATION_ZERO;
            assert_int_equal(hierarchy->leaf_flags[i].newly_kept >> lane & 1, expected);
        }
    }
    bvh_rig_destroy(&r);
}

TEST(flags_of_sets) {
    assert_false(orientations_may_touch(ORIENTATION_PLUS, ORIENTATION_PLUS));
    assert_false(orientations_may_touch(ORIENTATION_MINUS, ORIENTATION_MINUS));
    assert_true(orientations_may_touch(ORIENTATION_PLUS, ORIENTATION_MINUS));
    assert_true(orientations_may_touch(ORIENTATION_ZERO, ORIENTATION_PLUS));
    assert_true(orientations_may_touch(ORIENTATION_MINUS, ORIENTATION_ZERO));
    assert_true(orientations_may_touch(ORIENTATION_ZERO, ORIENTATION_ZERO));
}

AROUND_EACH(seed_random, NULL)
