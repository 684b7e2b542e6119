/* The kernels of the static check, compared with exact predicates: pairs that they reject never intersect,
 * and the signs of normals are right. All levels that this machine has find the same, and few pairs that are left
 * are disjoint. */
#include "runtime/intersections/static_check.h"
#include "src/mesh/predicates.h"
#include "tests/support/random.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BATCH_MAX = 700, BATCHES = NIGHTLY(120, 600) };

static int seed_random(void **state) {
    (void)state;
    random_seed(20260405);
    return 0;
}

/* ---- pairs ------------------------------------------------------------------------------------------- */

/* Pair i is triangles 2 i and 2 i + 1 with six vertices of its own, some of which may be unused. */
static struct {
    uint32_t count, triangles[2 * BATCH_MAX][3];
    double positions[BATCH_MAX * 18];
} work;

/* NEAR: random, about one triangle's size apart.
 * GRID: integers from -3 to 3, so that points coincide and share lines and planes.
 * FLAT: points of GRID or NEAR in one plane, rounded; the rounding may be all that keeps triangles apart.
 * WIDE: each point is scaled by a factor of its own. */
typedef enum family { NEAR, GRID, FLAT, WIDE, FAMILY_COUNT } family;

static const char *const family_names[FAMILY_COUNT] = {"near", "grid", "flat", "wide"};

static void make_point(family f, const double plane[2][3], double scale, double out[3]) {
    double p[3], own = f == WIDE ? ldexp(1.0, random_integer(-299, 298)) : 1.0;
    bool grid = f == GRID || (f == FLAT && plane[0][0] < 0.0);
    for (int k = 0; k < 3; k++) p[k] = grid ? random_integer(-3, 3) : 1.5 * random_unit();
    for (int k = 0; k < 3 && f == FLAT; k++) out[k] = plane[0][k] * p[0] + plane[1][k] * p[1];
    for (int k = 0; k < 3 && f != FLAT; k++) out[k] = p[k] * own;
    for (int k = 0; k < 3; k++) {
        out[k] *= scale;
        if (fabs(out[k]) < 0x1p-300) out[k] = 0.0;
    }
}

/* The second triangle begins with vertices of the first, followed by its own; both are rotated at random. */
static void make_pair(family f, int shared, int scale, uint32_t i) {
    double plane[2][3];
    for (int k = 0; k < 6; k++) plane[k / 3][k % 3] = random_unit();
    for (uint32_t v = 0; v < 6; v++)
        make_point(f, (const double(*)[3])plane, ldexp(1.0, scale), work.positions + (i * 6 + v) * 3);
    uint32_t turn_a = (uint32_t)random_integer(0, 2), turn_b = (uint32_t)random_integer(0, 2);
    bool flip = random_integer(0, 1) == 1;
    for (uint32_t v = 0; v < 3; v++) {
        uint32_t own = (int)v < shared ? (v + 1) % 3 : 3 + v, place = (v + turn_b) % 3;
        work.triangles[2 * i][(v + turn_a) % 3] = 6 * i + v;
        work.triangles[2 * i + 1][flip ? 2 - place : place] = 6 * i + own;
    }
}

static void make_batch(family f, int shared) {
    int scale = f == WIDE || random_integer(0, 1) == 0 ? 0 : random_integer(-296, 296);
    work.count = (uint32_t)random_integer(0, random_integer(0, 1) == 0 ? 20 : BATCH_MAX);
    for (uint32_t i = 0; i < work.count; i++)
        make_pair(f, shared >= 0 ? shared : random_integer(0, 3), scale, i);
}

static const uint32_t (*triangles_of_work(void))[3] {
    return (const uint32_t(*)[3])work.triangles;
}

static bool do_intersect(uint32_t i) {
    return triangles_intersect(work.triangles[2 * i], work.triangles[2 * i + 1], work.positions);
}

/* Runs the kernel of a level on all pairs; returns how many pairs it leaves. */
static uint32_t find_crossing(int level, bool keep_duplicates, triangle_pair *pairs, triangle_pair *crossing,
                              uint32_t *crossing_count) {
    for (uint32_t i = 0; i < work.count; i++) pairs[i] = (triangle_pair){2 * i, 2 * i + 1};
    return intersection_kernels_of(contexts[level])
        ->reject_disjoint(triangles_of_work(), work.positions, pairs, work.count, keep_duplicates, crossing,
                          crossing_count);
}

/* The same, with those that certainly intersect behind the others. */
static uint32_t reject_disjoint(int level, bool keep_duplicates, triangle_pair *pairs) {
    triangle_pair crossing[BATCH_MAX];
    uint32_t crossing_count, open = find_crossing(level, keep_duplicates, pairs, crossing, &crossing_count);
    assert_true(open + crossing_count <= work.count);
    memcpy(pairs + open, crossing, crossing_count * sizeof *pairs);
    return open + crossing_count;
}

/* Adds the number of pairs that meet, and how many of these the kernel finds. It finds no others. */
static void check_crossing(int level, uint64_t *meeting, uint64_t *found) {
    triangle_pair pairs[BATCH_MAX], crossing[BATCH_MAX];
    uint32_t crossing_count;
    find_crossing(level, false, pairs, crossing, &crossing_count);
    for (uint32_t i = 0; i < crossing_count; i++) assert_true(do_intersect(crossing[i].a / 2));
    for (uint32_t i = 0; i < work.count; i++) *meeting += do_intersect(i);
    *found += crossing_count;
}

/* Adds the number of disjoint pairs, and how many of these the kernel leaves undecided. */
static void check_batch(uint64_t *apart, uint64_t *open) {
    triangle_pair first[BATCH_MAX], other[BATCH_MAX];
    bool kept[BATCH_MAX] = {false};
    uint32_t count = reject_disjoint(0, false, first);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(first[i].a + 1, first[i].b);
        assert_false(kept[first[i].a / 2]);
        kept[first[i].a / 2] = true;
    }
    for (uint32_t i = 0; i < work.count; i++) {
        bool meeting = do_intersect(i);
        assert_true(kept[i] || !meeting);
        *apart += !meeting;
        *open += kept[i] && !meeting;
    }
    for (int level = 1; level < LEVEL_COUNT; level++) {
        if (contexts[level] == NULL) continue;
        assert_int_equal(reject_disjoint(level, false, other), count);
        assert_memory_equal(first, other, count * sizeof *first);
    }
}

static bool share_all(uint32_t i) {
    int shared = 0;
    for (int k = 0; k < 9; k++) shared += work.triangles[2 * i][k / 3] == work.triangles[2 * i + 1][k % 3];
    return shared == 3;
}

/* On demand pairs that share three vertices stay, beside the others; the order is the same on all levels. */
static void check_duplicates(void) {
    triangle_pair first[BATCH_MAX], other[BATCH_MAX];
    bool kept[BATCH_MAX] = {false};
    uint32_t without = reject_disjoint(0, false, other), count = reject_disjoint(0, true, first),
             duplicates = 0;
    for (uint32_t i = 0; i < count; i++) kept[first[i].a / 2] = true;
    for (uint32_t i = 0; i < work.count; i++) {
        duplicates += share_all(i);
        assert_true(kept[i] || !share_all(i));
    }
    for (uint32_t i = 0; i < without; i++) assert_true(kept[other[i].a / 2]);
    assert_int_equal(count, without + duplicates);
    for (int level = 1; level < LEVEL_COUNT; level++) {
        if (contexts[level] == NULL) continue;
        assert_int_equal(reject_disjoint(level, true, other), count);
        assert_memory_equal(first, other, count * sizeof *first);
    }
}

/* Checks that the kernel leaves at most this percentage of disjoint pairs undecided. */
static void check_family(family f, int shared, double most) {
    uint64_t apart = 0, open = 0;
    for (int i = 0; i < BATCHES; i++) {
        make_batch(f, shared);
        check_batch(&apart, &open);
        check_duplicates();
    }
    double share = 100.0 * (double)open / (double)apart;
    printf("%s, %d shared: %llu apart, %.3f %% of them left open\n", family_names[f], shared,
           (unsigned long long)apart, share);
    assert_true(apart > 10000 && share <= most);
}

TEST(near_pairs) {
    for (int shared = 0; shared < 4; shared++) check_family(NEAR, shared, 0.1);
    check_family(NEAR, -1, 0.1);
}

TEST(crossing_pairs) {
    for (family f = NEAR; f < FAMILY_COUNT; f++) {
        uint64_t meeting = 0, found = 0, levels = 0;
        for (int level = 0; level < LEVEL_COUNT; level++) levels += contexts[level] != NULL;
        for (int i = 0; i < BATCHES / 6; i++) {
            make_batch(f, i % 4 == 0 ? 1 : 0);
            for (int level = 0; level < LEVEL_COUNT; level++) {
                if (contexts[level] != NULL) check_crossing(level, &meeting, &found);
            }
        }
        print_message("  %s: %llu meet, %llu of them found\n", family_names[f], (unsigned long long)meeting,
                      (unsigned long long)found);
        assert_true(meeting > 500 * levels && (f != NEAR || found * 10 > meeting * 6));
    }
}

TEST(degenerate_pairs) {
    for (int shared = -1; shared < 4; shared++) {
        check_family(GRID, shared, 1.0);
        check_family(FLAT, shared, 75.0);
        check_family(WIDE, shared, 60.0);
    }
}

/* Intersecting pairs are scaled until products or differences overflow. An infinity must not prove them
 * disjoint. */
TEST(overflow_certifies_nothing) {
    for (int i = 0; i < BATCHES; i++) {
        triangle_pair pairs[BATCH_MAX];
        uint32_t meeting = 0;
        double scale = ldexp(1.0, random_integer(300, 1022));
        work.count = BATCH_MAX;
        for (uint32_t j = 0; j < BATCH_MAX; j++) make_pair(i % 2 == 0 ? NEAR : GRID, (int)(j % 3), 0, j);
        for (uint32_t j = 0; j < BATCH_MAX; j++) {
            if (!do_intersect(j)) continue;
            memmove(work.triangles[2 * meeting], work.triangles[2 * j], 2 * sizeof *work.triangles);
            meeting++;
        }
        work.count = meeting;
        assert_true(meeting > 10);
        for (size_t k = 0; k < BATCH_MAX * 18; k++) work.positions[k] *= scale;
        for (int level = 0; level < LEVEL_COUNT; level++) {
            if (contexts[level] != NULL) assert_int_equal(reject_disjoint(level, false, pairs), meeting);
        }
    }
}

/* ---- single triangles -------------------------------------------------------------------------------- */

/* Every other triangle from the last one on is asked for; the bytes of the rest stay as they are. */
static void sign_normals(int level, uint8_t *normals, uint8_t *rises) {
    uint32_t list[BATCH_MAX], count = 0;
    for (uint32_t i = 0; i < work.count; i++) list[count++] = 2 * (work.count - 1 - i) + i % 2;
    memset(normals, 0xaa, (size_t)2 * BATCH_MAX);
    memset(rises, 0xaa, (size_t)2 * BATCH_MAX);
    intersection_kernels_of(contexts[level])
        ->sign_normals(triangles_of_work(), work.positions, list, count, normals, rises);
}

static int sign_of_normal(const double *const p[3], int axis) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    return orient2d(p[0][x], p[0][y], p[1][x], p[1][y], p[2][x], p[2][y]);
}

static uint8_t exact_rises(const double *const p[3]) {
    uint8_t rises = 0;
    for (int i = 0; i < 6; i++) {
        const double *at = p[i % 3], *next = p[(i + 1) % 3], *last = p[(i + 2) % 3];
        int y = i < RISES_ALONG_Y ? 2 : 1;
        rises |= (uint8_t)((next[y] < at[y] && last[y] >= at[y]) << i);
    }
    return rises;
}

/* Counts the axes along which the exact sign is not 0, and those whose sign was found. */
static void check_signs(uint32_t triangle, uint8_t normals, uint64_t *signs, uint64_t *found) {
    const double *p[3];
    for (int i = 0; i < 3; i++) p[i] = work.positions + (size_t)work.triangles[triangle][i] * 3;
    for (int k = 0; k < 3; k++) {
        int exact = sign_of_normal(p, k), claimed = normals >> (2 * k) & 3;
        assert_true(claimed == 0 || claimed == (exact > 0 ? 1 : exact < 0 ? 2 : 3));
        *signs += exact != 0;
        *found += claimed != 0;
    }
}

TEST(signs_of_normals) {
    uint64_t signs = 0, found = 0;
    for (int i = 0; i < BATCHES; i++) {
        static uint8_t normals[2][2 * BATCH_MAX], rises[2][2 * BATCH_MAX];
        make_batch((family)(i % FAMILY_COUNT), -1);
        sign_normals(0, normals[0], rises[0]);
        for (uint32_t t = 0; t < 2 * work.count; t++) {
            const double *p[3];
            for (int k = 0; k < 3; k++) p[k] = work.positions + (size_t)work.triangles[t][k] * 3;
            bool asked = (work.count - 1 - t / 2) % 2 == t % 2;
            if (asked) check_signs(t, normals[0][t], &signs, &found);
            assert_int_equal(rises[0][t], asked ? exact_rises(p) : 0xaa);
            assert_true(asked || normals[0][t] == 0xaa);
        }
        for (int level = 1; level < LEVEL_COUNT; level++) {
            if (contexts[level] == NULL) continue;
            sign_normals(level, normals[1], rises[1]);
            assert_memory_equal(normals[0], normals[1], sizeof normals[0]);
            assert_memory_equal(rises[0], rises[1], sizeof rises[0]);
        }
    }
    print_message("  %llu signs, %llu of them found\n", (unsigned long long)signs, (unsigned long long)found);
    assert_true(signs > 1000 && found * 10 > signs * 9);
}

AROUND_EACH(seed_random, NULL)
AROUND_ALL(open_levels, close_levels)
