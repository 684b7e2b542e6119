/* A vertex and a half-space, against integers: verdicts, times, gaps, and floors over many motions. */
#include "runtime/ccd/ccd.h"

#include "tests/support/ccd/wide_numbers.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

typedef struct exact_integer exact_number;

/* The height times the normal's length, in the unit of products. */
static exact_number exact_height(const double x[2][3], const double normal[3]) {
    exact_number sum = {0};
    for (int k = 0; k < 3; k++) {
        exact_number a = exact_from_double(x[0][k]), b = exact_from_double(x[1][k]),
                     n = exact_from_double(normal[k]);
        exact_number offset = exact_subtract(&a, &b), part = exact_multiply(&offset, &n);
        sum = exact_add(&sum, &part);
    }
    return sum;
}

/* Is t at most g0 / (g0 - g1)? t = m / 2^53 with a whole m. */
static bool not_later(double t, const exact_number *g0, const exact_number *g1) {
    exact_number whole = exact_from_double(t), one = exact_from_double(1.0);
    exact_number between = exact_subtract(g0, g1), left = exact_multiply(&whole, &between),
                 right = exact_multiply(&one, g0);
    return exact_subtract(&left, &right).sign <= 0;
}

/* Coordinates of all sizes, near each other and far apart, and such as lie in the plane exactly or by a hair. */
static double any_number(random_stream *random, uint32_t family) {
    double x = stream_between(random, -1.0, 1.0);
    switch (family) {
    case 0:
        return (double)(int)stream_below(random, 7) - 3.0;
    case 1:
        return x;
    case 2:
        return stream_below(random, 3) == 0
                   ? 0.0
                   : ldexp(x < 0 ? x - 1.0 : x + 1.0, (int)stream_below(random, 590) - 295);
    case 3:
        return 1e6 + floor(x * 4.0) * 0.25;
    default:
        return 1.0 + floor(x * 4.0) * 0x1p-52;
    }
}

static void make_query(random_stream *random, half_space_query *q) {
    uint32_t family = stream_below(random, 5), of_normal = stream_below(random, 3);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 2; i++) {
            q->x0[i][k] = any_number(random, family);
            q->x1[i][k] = any_number(random, family);
        }
        q->normal[k] = any_number(random, of_normal);
    }
    if (stream_below(random, 4) == 0) memcpy(q->x1, q->x0, sizeof q->x1);
    if (stream_below(random, 4) == 0) memcpy(q->x1[1], q->x0[1], sizeof q->x1[1]);
    if (q->normal[0] == 0.0 && q->normal[1] == 0.0 && q->normal[2] == 0.0) q->normal[2] = 1.0;
}

TEST(verdicts_and_times) {
    random_stream random = stream_start(1);
    size_t touching = 0, apart = 0, by_integers = 0, in_between = 0;
    for (int i = 0; i < 300000; i++) {
        half_space_query q;
        elementary_contact c = {.toi = -1.0};
        make_query(&random, &q);
        exact_number start = exact_height((const double(*)[3])q.x0, q.normal),
                     end = exact_height((const double(*)[3])q.x1, q.normal);
        elementary_verdict verdict = half_space_touch(&q, &c);
        assert_true(verdict.touching == (start.sign <= 0 || end.sign <= 0));
        touching += verdict.touching;
        apart += !verdict.touching;
        by_integers += verdict.level == ELEMENTARY_EXACT;
        if (!verdict.touching) continue;
        assert_true(start.sign <= 0 ? c.toi == 0.0 : c.toi >= 0.0 && c.toi <= 1.0);
        if (start.sign <= 0) continue;
        in_between++;
        assert_true(not_later(c.toi, &start, &end));
        if (c.toi + 1e-9 < 1.0) assert_false(not_later(c.toi + 1e-9, &start, &end));
    }
    print_message("  %zu touch, %zu later than at the start, %zu do not, %zu by integers\n", touching,
                  in_between, apart, by_integers);
    assert_true(apart > 20000 && in_between > 20000 && by_integers > 5000);
}

/* At most what there is, and at least 0.985 of it, also where the length is the height up to its last bits. */
TEST(gaps_below_truth) {
    random_stream random = stream_start(2);
    size_t some = 0, none = 0;
    for (int i = 0; i < 100000; i++) {
        double x[2][3], normal[3] = {3.0, 0.0, 4.0}; /* so that the height is rational */
        for (int k = 0; k < 6; k++)
            x[k / 3][k % 3] = floor(stream_between(&random, -1.0, 1.0) * 0x1p20) * 0x1p-20;
        double height = (3.0 * (x[0][0] - x[1][0]) + 4.0 * (x[0][2] - x[1][2])) / 5.0;
        double beside = 1.0 + ldexp(stream_between(&random, -1.0, 1.0), -(int)stream_below(&random, 60));
        double length = stream_below(&random, 4) == 0 || height < 0.0 ? 0.0 : height * beside;
        double gap = half_space_gap((const double(*)[3])x, normal, length);
        long double truth =
            3.0L * (x[0][0] - x[1][0]) + 4.0L * (x[0][2] - x[1][2]) - 5.0L * length; /* exact, five times */
        assert_true(gap >= 0.0 && (gap == 0.0 || 5.0L * gap <= truth));
        if (truth > 0.0L) assert_true(5.0L * gap >= 0.985L * truth);
        some += gap > 0.0;
        none += gap == 0.0;
    }
    assert_true(some > 10000 && none > 10000);
}

TEST(planes_of_half_spaces) {
    random_stream random = stream_start(3);
    size_t sound = 0;
    for (int i = 0; i < 100000; i++) {
        half_space_query q;
        pair_plane plane;
        make_query(&random, &q);
        for (int k = 0; k < 3; k++)
            q.normal[k] = ldexp(stream_between(&random, -1.0, 1.0), (int)(i % 500) - 250);
        double length = half_space_plane((const double(*)[3])q.x0, q.normal, &plane);
        exact_number height = exact_height((const double(*)[3])q.x0, plane.normal),
                     one = exact_from_double(1.0);
        if (fabs(plane.gap) > 0x1p-290 && fabs(plane.gap) < 0x1p290) {
            exact_number gap = exact_from_double(plane.gap), scaled = exact_multiply(&gap, &one);
            assert_true(exact_subtract(&scaled, &height).sign <= 0);
            sound++;
        }
        assert_true(length >= 1.0 && length <= 4.0);
        double factor = q.normal[0] / plane.normal[0];
        int exponent;
        assert_true(frexp(factor, &exponent) == 0.5);
        for (int k = 0; k < 3; k++) assert_true(q.normal[k] == plane.normal[k] * factor);
    }
    assert_true(sound > 50000);
}

/* ---- with a distance --------------------------------------------------------------------------------------- */

static long double height_of(const double x[2][3], const double normal[3]) {
    long double sum = 0, squared = 0;
    for (int k = 0; k < 3; k++) {
        sum += ((long double)x[0][k] - x[1][k]) * normal[k];
        squared += (long double)normal[k] * normal[k];
    }
    return sum / sqrtl(squared);
}

static void moment_of(const half_space_query *q, long double t, long double *height) {
    *height = (1 - t) * height_of(q->x0, q->normal) + t * height_of(q->x1, q->normal);
}

TEST(with_a_distance) {
    random_stream random = stream_start(4);
    size_t within = 0, later = 0;
    for (int i = 0; i < 200000; i++) {
        half_space_query q;
        elementary_contact c;
        for (int k = 0; k < 12; k++)
            (k < 6 ? q.x0[k / 3] : q.x1[k / 3 - 2])[k % 3] = stream_between(&random, -1.0, 1.0);
        for (int k = 0; k < 3; k++) q.normal[k] = stream_between(&random, -2.0, 2.0);
        double d = stream_between(&random, 0.0, 0.3);
        long double start = height_of(q.x0, q.normal), end = height_of(q.x1, q.normal), at;
        bool found = half_space_within(&q, d, &c);
        if (start < d || end < d) assert_true(found);
        if (start > d * (1 + 1e-12) && end > d * (1 + 1e-12)) assert_false(found);
        if (!found) continue;
        within++;
        moment_of(&q, c.toi, &at);
        assert_true(at <= d * (1 + 1e-6L));
        if (c.toi == 0.0) continue;
        assert_true(at >= d);
        later++;
    }
    assert_true(within > 10000 && later > 10000);
}

/* However often it is pressed down, a vertex loses no rung, and one that rises is never refused. */
TEST(floors_hold) {
    random_stream random = stream_start(5);
    const floor_ladder ladder = {0.1, 0.9, 1e-6};
    size_t broken = 0, kept = 0;
    for (int run = 0; run < 200; run++) {
        half_space_query q;
        for (int k = 0; k < 3; k++) {
            q.normal[k] = stream_between(&random, -1.0, 1.0) + (k == 1 ? 2.0 : 0.0);
            q.x0[1][k] = stream_between(&random, -1.0, 1.0);
        }
        double length =
            sqrt(q.normal[0] * q.normal[0] + q.normal[1] * q.normal[1] + q.normal[2] * q.normal[2]);
        double begin = stream_between(&random, 0.001, 0.2);
        for (int k = 0; k < 3; k++) q.x0[0][k] = q.x0[1][k] + begin * q.normal[k] / length;
        double floor = ladder.distance;
        while (floor >= begin * (1 - 2e-6)) floor *= ladder.ratio;
        for (int step = 0; step < 500; step++) {
            elementary_contact c;
            double drop = stream_between(&random, -0.02, 0.005);
            for (int k = 0; k < 3; k++) {
                q.x1[1][k] = q.x0[1][k];
                q.x1[0][k] = q.x0[0][k] + drop * q.normal[k] / length +
                             stream_between(&random, -0.001, 0.001) * (k == 0);
            }
            floor_verdict verdict = half_space_floor_test(&q, &ladder, &c);
            assert_true(verdict != FLOOR_NONE);
            long double after = height_of(q.x1, q.normal);
            if (verdict == FLOOR_KEPT) memcpy(q.x0, q.x1, sizeof q.x0);
            if (verdict == FLOOR_KEPT) assert_true(after > floor);
            if (verdict == FLOOR_BROKEN)
                assert_true(after < height_of(q.x0, q.normal) && c.toi >= 0.0 && c.toi <= 1.0);
            kept += verdict == FLOOR_KEPT;
            broken += verdict == FLOOR_BROKEN;
        }
        memcpy(q.x1, q.x0, sizeof q.x1);
        elementary_contact c;
        assert_int_equal(half_space_floor_test(&q, &ladder, &c), FLOOR_KEPT);
    }
    assert_true(kept > 1000 && broken > 1000);
}

/* On the plane, behind it and a hair above it there is no floor, so touching decides. */
TEST(no_floor) {
    const floor_ladder ladder = {0.1, 0.9, 1e-6};
    static const double heights[4] = {0.0, -1.0, 0x1p-50, 0x1p-41};
    for (int i = 0; i < 4; i++) {
        half_space_query q = {
            {{1.0, 0.0, heights[i]}, {0.0, 0.0, 0.0}}, {{1.0, 0.0, 1.0}, {0.0, 0.0, 0.0}}, {0.0, 0.0, 7.0}};
        elementary_contact c;
        assert_int_equal(half_space_floor_test(&q, &ladder, &c), FLOOR_NONE);
        assert_true(half_space_touch(&q, &c).touching == (heights[i] <= 0.0));
    }
}
