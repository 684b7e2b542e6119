/* A skin that holds is no thicker than it says, every sign it keeps is right throughout the interval, and it does hold where
 * little has moved. */
#include "runtime/bvh/bvh_parts.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TRIALS = 150, MOMENTS = 9 };

static scene shape; /* large; one test at a time */
static double middle[SCENE_VERTICES_MAX * 3], end[SCENE_VERTICES_MAX * 3];

static int seed_random(void **state) {
    (void)state;
    random_seed(43);
    return 0;
}

/* ---- a reference ------------------------------------------------------------------------------------------- */

typedef struct skin_rig {
    bvh_rig rig;
    bvh_skin skin;
    double distance;
} skin_rig;

/* The detector points of all regions are so far below the middles of these. */
static bool skin_rig_begin(cscd_simd simd, uint32_t region_count, double distance, double least, double below,
                           skin_rig *out) {
    static uint8_t facing[SCENE_TRIANGLES_MAX];
    double offsets[8][3] = {{0.0}};
    for (int i = 0; i < 8; i++) offsets[i][2] = -below;
    static bool culled[SCENE_TRIANGLES_MAX]; /* components */
    memset(culled, true, sizeof culled);
    *out = (skin_rig){.distance = distance};
    if (!bvh_rig_create(&shape, (bvh_setup){simd, 2, BOX_AXES, region_count}, &out->rig)) return false;
    bvh *hierarchy = &out->rig.bvh;
    bvh_refit(hierarchy, shape.x0, shape.x0, uniform_growth(2.0 * distance));
    assert_true(bvh_skin_reserve(&out->skin, hierarchy));
    const orientation_lasting lasting = bvh_skin_lasting(&out->skin, hierarchy, distance, least);
    const orientation_query query = {
        .culled = culled, .detector_offsets = (const double(*)[3])offsets, .lasting = &lasting};
    bvh_orient(hierarchy, &query, facing);
    bvh_skin_set(&out->skin, hierarchy, distance);
    return true;
}

static void skin_rig_end(skin_rig *r) {
    bvh_skin_free(&r->skin);
    bvh_rig_destroy(&r->rig);
}

/* ---- motions ----------------------------------------------------------------------------------------------- */

static double extent_of_edges(void) {
    const double *p = shape.x0 + 3 * (size_t)shape.triangles[0],
                 *q = shape.x0 + 3 * (size_t)shape.triangles[1];
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

static double at_times(double x) {
    return random_integer(0, 1) == 0 ? x : 0.0;
}

/* Everything moves by much, a half of the vertices by little more, waves run over it, and vertices shake. */
static void move_from(const double *from, double size, double *to) {
    double all = 10.0 * random_unit(), half = 3.0 * size * random_unit(),
           wave = at_times(size * random_unit());
    double shake = at_times(size * random_unit()), phase = random_unit();
    for (uint32_t v = 0; v < shape.vertex_count; v++) {
        double along = sin(2.0 * (shape.x0[3 * (size_t)v] + phase));
        for (size_t k = 0; k < 3; k++)
            to[3 * (size_t)v + k] = from[3 * (size_t)v + k] + all +
                                    (v < shape.vertex_count / 2 ? half : 0.0) + wave * along +
                                    shake * random_unit();
    }
    if (random_integer(0, 3) == 0)
        to[3 * (size_t)random_integer(0, (int)shape.vertex_count - 1)] += 2.0 * size;
}

/* ---- what must be true ------------------------------------------------------------------------------------- */

/* Where a record is in the frame of its tree, at one end of the interval looked at. */
static void place_record(const skin_rig *r, uint32_t tree, uint32_t record, const double *x, int at,
                         long double out[3]) {
    const double *p = x + 3 * (size_t)r->skin.vertices[record];
    for (int k = 0; k < 3; k++)
        out[k] = ((long double)p[k] - r->skin.trees[tree].ends[at][k]) * (long double)r->skin.scale;
}

/* Returns the farthest that a vertex is off, with what its frame has moved against that of the first tree, as a length. */
static long double farthest_of(const skin_rig *r, const double *x) {
    const bvh_skin *s = &r->skin;
    long double farthest = 0.0L;
    for (uint32_t t = 0; t < s->tree_count; t++) {
        const skin_tree *tree = &s->trees[t], *first = &s->trees[0];
        long double shift = 0.0L;
        for (int k = 0; k < 3; k++) {
            long double by = ((long double)tree->ends[1][k] - tree->origin[k]) -
                             ((long double)first->ends[1][k] - first->origin[k]);
            shift += by * by;
        }
        for (uint32_t i = tree->first_record; i < tree->first_record + tree->record_count; i++) {
            long double at[3], sum = 0.0L;
            place_record(r, t, i, x, 1, at);
            for (int k = 0; k < 3; k++) sum += (at[k] - s->items[i][k]) * (at[k] - s->items[i][k]);
            farthest = fmaxl(farthest, sqrtl(shift) + sqrtl(sum) / s->scale);
        }
    }
    return farthest;
}

static long double facing_of(long double p[3][3], const float d[3]) {
    long double a[3], b[3], c[3];
    for (int k = 0; k < 3; k++) {
        a[k] = p[1][k] - p[0][k];
        b[k] = p[2][k] - p[0][k];
        c[k] = p[0][k] - (long double)d[k];
    }
    return c[0] * (a[1] * b[2] - a[2] * b[1]) + c[1] * (a[2] * b[0] - a[0] * b[2]) +
           c[2] * (a[0] * b[1] - a[1] * b[0]);
}

/* Are all signs of a leaf right at one moment of the interval from x0 to x1? */
static bool signs_are_right(const skin_rig *r, const skin_leaf *leaf, const double *x0, const double *x1,
                            long double moment) {
    for (int lane = 0; lane < LANES; lane++) {
        int sign = (leaf->plus >> lane & 1) - (leaf->minus >> lane & 1);
        long double corners[3][3];
        for (int i = 0; i < 3; i++) {
            long double start[3], stop[3];
            place_record(r, leaf->tree, leaf->corners[i * LANES + lane], x0, 0, start);
            place_record(r, leaf->tree, leaf->corners[i * LANES + lane], x1, 1, stop);
            for (int k = 0; k < 3; k++) corners[i][k] = start[k] + moment * (stop[k] - start[k]);
        }
        if (sign != 0 && !(sign * facing_of(corners, r->skin.trees[leaf->tree].detector) > 0.0L))
            return false;
    }
    return true;
}

static bool all_signs_are_right(const skin_rig *r, const double *x0, const double *x1) {
    for (uint32_t i = 0; i < r->skin.leaf_count; i++) {
        for (int m = 0; m < MOMENTS; m++) {
            if (!signs_are_right(r, &r->skin.leaves[i], x0, x1, m / (MOMENTS - 1.0L))) return false;
        }
    }
    return true;
}

/* ---- tests -------------------------------------------------------------------------------------------------- */

typedef struct outcomes {
    int held, too_far, too_bent, shy;
} outcomes;

/* Looks at one interval. */
static bool look_at(skin_rig *r, const double *x0, const double *x1, outcomes *count) {
    bool holds = bvh_skin_holds(&r->skin, x0, x1);
    long double farthest = farthest_of(r, x1);
    bool right = all_signs_are_right(r, x0, x1);
    if (holds) assert_true(farthest < r->distance && right);
    count->held += holds;
    count->too_far += farthest >= r->distance;
    count->too_bent += farthest < r->distance && !right;
    count->shy += !holds && farthest < 0.99L * r->distance && right;
    return holds;
}

TEST(what_holds_is_true) {
    static const scene_family kinds[] = {SCENE_LINKED_TORI, SCENE_NOISY_SPHERE, SCENE_TWO_SPHERES};
    outcomes count = {0};
    for (int i = 0; i < TRIALS; i++) {
        skin_rig r;
        scene_make(kinds[i % 3], 100 + (uint64_t)i, &shape);
        double distance = extent_of_edges() * ldexp(1.0, -random_integer(1, 6));
        assert_true(skin_rig_begin(CSCD_SIMD_AUTO, i % 2 == 0 ? 0 : 3, distance, 0.02 * distance, 0.0, &r));
        for (int k = 0; k < 8; k++) {
            double size = 0.5 * distance * fabs(random_unit());
            move_from(shape.x0, size, middle);
            memset(r.skin.stray_at_start, 0,
                   r.skin.leaf_count * sizeof *r.skin.stray_at_start); /* at the reference again */
            if (!look_at(&r, shape.x0, middle, &count)) continue;
            bvh_skin_take(&r.skin);
            move_from(middle, size, end); /* the second interval starts where the first one has ended */
            look_at(&r, middle, end, &count);
        }
        skin_rig_end(&r);
    }
    printf("%d held, %d too far, %d bent too much, %d held back though nothing was wrong\n", count.held,
           count.too_far, count.too_bent, count.shy);
    assert_true(count.held > 200 && count.too_far > 100 && count.too_bent > 5 && count.shy < count.held / 10);
}

enum { OTHERS = 23 };

/* A flat triangle with its third corner here, and others side by side, all in one plane. */
static void lay_triangles(double x, double y) {
    scene_clear(&shape);
    shape.vertex_count = 3 * (OTHERS + 1);
    shape.triangle_count = OTHERS + 1;
    for (uint32_t i = 0; i < shape.vertex_count; i++) shape.triangles[i] = i;
    for (uint32_t t = 0; t <= OTHERS; t++) {
        const double corners[9] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, t == 0 ? x : 0.5, t == 0 ? y : 0.5, 0.0};
        for (size_t i = 0; i < 9; i++)
            shape.x0[9 * (size_t)t + i] = corners[i] + (i % 3 == 1 ? -0.1 * t : 0.0);
    }
}

/* A flat triangle far in front of its detector point, among others that do not move. */
static void place_flat_triangle(double x1, double y1, double x2, double y2, double *x) {
    memcpy(x, shape.x0, shape.vertex_count * sizeof(double[3]));
    x[3] = x1;
    x[4] = y1;
    x[6] = x2;
    x[7] = y2;
}

/* It turns away by more than its signs last for, in so small intervals that each of them is seen to keep the sign, and comes
 * back in one interval, in the midst of which it is turned over. Its end alone says nothing of that. */
TEST(out_slowly_and_back_at_once) {
    enum { WAY = 20 };
    skin_rig r;
    lay_triangles(0.5, 0.004);
    assert_true(skin_rig_begin(CSCD_SIMD_AUTO, 1, 0.2, 0.0005, 40.0, &r));
    memcpy(end, shape.x0, sizeof end);
    for (int i = 1; i <= WAY; i++) {
        double u = (double)i / WAY, y1 = -0.08 * u, x2 = 0.5 + 0.08 * u;
        memcpy(middle, end, sizeof middle);
        place_flat_triangle(1.0, y1, x2, y1 * x2 + 0.004 - 0.0035 * u, end);
        assert_true(bvh_skin_holds(&r.skin, middle, end) && all_signs_are_right(&r, middle, end));
        bvh_skin_take(&r.skin);
    }
    memcpy(middle, end, sizeof middle);
    place_flat_triangle(1.0, 0.0, 0.5, 0.002, end);
    bool holds = bvh_skin_holds(&r.skin, middle, end);
    assert_false(all_signs_are_right(&r, middle, end));
    assert_false(holds);
    skin_rig_end(&r);
}

/* The first corner, between the others, moves across the side opposite it. No motion of so small an extent turns a flat
 * triangle sooner, so hardly anything is left between what a sign surely lasts for and where it is wrong. */
TEST(turned_over_by_the_least_stretch) {
    enum { WAY = 40, UP_TO_SIDE = 20 };
    skin_rig r;
    int held = 0;
    lay_triangles(-1.0, 0.004);
    assert_true(skin_rig_begin(CSCD_SIMD_AUTO, 1, 0.2, 0.0005, 40.0, &r));
    for (int i = 1; i <= WAY; i++) {
        memcpy(end, shape.x0, sizeof end);
        end[1] = 0.002 * i / UP_TO_SIDE;
        bool holds = bvh_skin_holds(&r.skin, shape.x0, end);
        assert_int_equal(all_signs_are_right(&r, shape.x0, end), i < UP_TO_SIDE);
        assert_true(i < UP_TO_SIDE || !holds);
        held += holds;
    }
    assert_true(held > UP_TO_SIDE / 2);
    skin_rig_end(&r);
}

TEST(levels_agree) {
    scene_make(SCENE_LINKED_TORI, 7, &shape);
    double distance = 0.2 * extent_of_edges();
    skin_rig first;
    assert_true(skin_rig_begin(CSCD_SIMD_SCALAR, 3, distance, 0.1 * distance, 0.0, &first));
    for (int simd = CSCD_SIMD_SCALAR + 1; simd <= SIMD_LAST; simd++) {
        skin_rig r;
        if (!skin_rig_begin((cscd_simd)simd, 3, distance, 0.1 * distance, 0.0, &r)) continue;
        assert_memory_equal(r.skin.stretches, first.skin.stretches,
                            first.skin.leaf_count * sizeof *first.skin.stretches);
        for (int k = 0; k < 20; k++) {
            move_from(shape.x0, 0.4 * distance * random_unit(), end);
            assert_int_equal(bvh_skin_holds(&r.skin, shape.x0, end),
                             bvh_skin_holds(&first.skin, shape.x0, end));
            assert_memory_equal(r.skin.items, first.skin.items,
                                first.skin.record_count * sizeof *first.skin.items);
        }
        skin_rig_end(&r);
    }
    skin_rig_end(&first);
}

AROUND_EACH(seed_random, NULL)
