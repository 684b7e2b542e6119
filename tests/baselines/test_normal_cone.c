/* Normal cones contain every normal of moving triangles, by a reference in long double; as published they
 * do not. */
#include "runtime/baselines/patches.h"
#include "tests/support/random.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

enum { TRIANGLES = 40000, MOMENTS = 17 };

typedef struct moving_triangle {
    double x0[9], x1[9];
} moving_triangle;

/* ---- one cone, by every level and in every lane -------------------------------------------------------- */

static normal_cone same_in_all_lanes(const normal_cone cones[LANES], const normal_cone *before) {
    for (int i = 0; i < LANES; i++)
        assert_memory_equal(&cones[i], before != NULL ? before : cones, sizeof *cones);
    return cones[0];
}

static normal_cone cone_between(const double *x0, const double *x1, bool published) {
    static const uint32_t triangles[1][3] = {{0, 1, 2}}, which[LANES] = {0};
    normal_cone cones[LANES], cone = {{0.0f, 0.0f, 0.0f}, 0.0f};
    for (int level = 0; level < LEVEL_COUNT; level++) {
        if (contexts[level] == NULL) continue;
        normal_cone_kernels_of(contexts[level])->of_triangles(triangles, which, x0, x1, published, cones);
        cone = same_in_all_lanes(cones, level > 0 ? &cone : NULL);
    }
    return cone;
}

static normal_cone cone_of(const moving_triangle *m) {
    return cone_between(m->x0, m->x1, false);
}

static normal_cone union_of(const normal_cone *a, const normal_cone *b) {
    static const uint32_t first[LANES] = {0}, second[LANES] = {1, 1, 1, 1, 1, 1, 1, 1};
    const normal_cone both[2] = {*a, *b};
    normal_cone cones[LANES], cone = *a;
    for (int level = 0; level < LEVEL_COUNT; level++) {
        if (contexts[level] == NULL) continue;
        normal_cone_kernels_of(contexts[level])->of_unions(both, first, second, normal_cone_limit, cones);
        cone = same_in_all_lanes(cones, level > 0 ? &cone : NULL);
    }
    return cone;
}

/* One cone of up to eight triangles, which stand in the lanes again and again. */
static normal_cone cone_of_all(const moving_triangle *all, uint32_t count) {
    uint32_t triangles[LANES][3], which[LANES];
    double x0[LANES * 9], x1[LANES * 9];
    normal_cone cone = {{0.0f, 0.0f, 0.0f}, 0.0f};
    for (uint32_t i = 0; i < LANES; i++) {
        which[i] = i % count;
        for (uint32_t k = 0; k < 3; k++) triangles[i][k] = 3 * i + k;
        if (i >= count) continue;
        memcpy(x0 + 9 * i, all[i].x0, sizeof all[i].x0);
        memcpy(x1 + 9 * i, all[i].x1, sizeof all[i].x1);
    }
    for (int level = 0; level < LEVEL_COUNT; level++) {
        normal_cone other;
        if (contexts[level] == NULL) continue;
        normal_cone_kernels_of(contexts[level])
            ->of_eight((const uint32_t(*)[3])triangles, which, x0, x1, level > 0 ? &other : &cone);
        if (level > 0) assert_memory_equal(&other, &cone, sizeof cone);
    }
    return cone;
}

/* ---- the reference ------------------------------------------------------------------------------------- */

/* Computes the normal up to a factor. */
static void normal_at(const moving_triangle *m, long double t, long double out[3]) {
    long double e[2][3];
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++)
            e[i][k] = (1.0L - t) * ((long double)m->x0[3 * i + 3 + k] - (long double)m->x0[k]) +
                      t * ((long double)m->x1[3 * i + 3 + k] - (long double)m->x1[k]);
    }
    for (int k = 0; k < 3; k++)
        out[k] = e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
}

static long double angle_between(const float axis[3], const long double n[3]) {
    long double cross[3], across = 0.0L, along = 0.0L;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        cross[k] = (long double)axis[i] * n[j] - (long double)axis[j] * n[i];
        across += cross[k] * cross[k];
        along += (long double)axis[k] * n[k];
    }
    return atan2l(sqrtl(across), along);
}

/* Returns by how much the normal farthest from the axis, at any sampled moment, leaves the cone; below 0
 * when none does. */
static long double excess_angle(const normal_cone *cone, const moving_triangle *m) {
    long double most = -10.0L;
    for (int i = 0; i < MOMENTS; i++) {
        long double n[3];
        normal_at(m, (long double)i / (MOMENTS - 1), n);
        long double beyond = angle_between(cone->axis, n) - (long double)cone->angle;
        if (!(beyond <= most)) most = beyond; /* also when it is not a number */
    }
    return most;
}

/* Makes a triangle that may be a sliver or far from the origin. change: how far coordinates of about 1
 * move. */
static moving_triangle random_triangle(random_stream *random, double change) {
    moving_triangle m;
    double at = stream_below(random, 4) == 0 ? stream_between(random, -1e5, 1e5) : 0.0;
    for (int i = 0; i < 9; i++) m.x0[i] = stream_between(random, -1.0, 1.0);
    if (stream_below(random, 4) == 0) {
        double thin = exp(stream_between(random, log(1e-13), 0.0));
        change *= thin;
        for (int k = 0; k < 3; k++) m.x0[6 + k] = 0.7 * m.x0[k] + 0.3 * m.x0[3 + k] + thin * m.x0[6 + k];
    }
    for (int i = 0; i < 9; i++) {
        m.x0[i] += at;
        m.x1[i] = m.x0[i] + change * stream_between(random, -1.0, 1.0);
    }
    return m;
}

static double random_change(random_stream *random) {
    return exp(stream_between(random, log(1e-6), log(2.0)));
}

TEST(cones_hold_all_normals) {
    uint32_t exist = 0, wide = 0;
    long double most = -10.0L;
    random_stream random = stream_start(1);
    for (int i = 0; i < TRIANGLES; i++) {
        moving_triangle m = random_triangle(&random, random_change(&random));
        normal_cone cone = cone_of(&m);
        assert_true(normal_cone_exists(&cone) == (cone.angle < INFINITY));
        if (!normal_cone_exists(&cone)) continue;
        exist++;
        wide += cone.angle > 1.0f;
        most = fmaxl(most, excess_angle(&cone, &m));
    }
    print_message("  %u cones of %d, %u wide; the nearest normal is %.1Le inside\n", exist, TRIANGLES, wide,
                  -most);
    assert_true(2 * exist > TRIANGLES && wide > 200);
    assert_true(most < 0.0L);
}

TEST(published_cones_lose_normals) {
    uint32_t lost = 0, exist = 0;
    random_stream random = stream_start(2);
    for (int i = 0; i < TRIANGLES; i++) {
        moving_triangle m = random_triangle(&random, random_change(&random));
        normal_cone cone = cone_between(m.x0, m.x1, true);
        if (!(cone.angle < INFINITY)) continue;
        exist++;
        lost += excess_angle(&cone, &m) > 1e-3L;
    }
    print_message("  as published: %u of %u cones do not hold all normals\n", lost, exist);
    assert_true(lost > 200);
}

/* Unites the cones of eight triangles in a tree, as the nodes of the hierarchy do, and makes one of all. */
TEST(unions_hold_all_normals) {
    uint32_t exist = 0, exist_of_all = 0;
    long double most = -10.0L, most_of_all = -10.0L;
    random_stream random = stream_start(3);
    for (int i = 0; i < TRIANGLES / 8; i++) {
        moving_triangle first = random_triangle(&random, 0.2), all[8];
        normal_cone cones[8];
        double change = exp(stream_between(&random, log(1e-4), log(0.5)));
        for (int j = 0; j < 8; j++) {
            all[j] = first;
            for (int k = 0; k < 9; k++) {
                all[j].x0[k] += change * stream_between(&random, -1.0, 1.0);
                all[j].x1[k] += change * stream_between(&random, -1.0, 1.0);
            }
            cones[j] = cone_of(&all[j]);
        }
        for (int step = 1; step < 8; step *= 2) {
            for (int j = 0; j < 8; j += 2 * step) cones[j] = union_of(&cones[j], &cones[j + step]);
        }
        const normal_cone of_all = cone_of_all(all, 8);
        if (normal_cone_exists(&of_all)) {
            exist_of_all++;
            for (int j = 0; j < 8; j++) most_of_all = fmaxl(most_of_all, excess_angle(&of_all, &all[j]));
        }
        if (!normal_cone_exists(&cones[0])) continue;
        exist++;
        for (int j = 0; j < 8; j++) most = fmaxl(most, excess_angle(&cones[0], &all[j]));
    }
    print_message("  %u unions of %d; the nearest normal is %.1Le inside; %u of all, %.1Le\n", exist,
                  TRIANGLES / 8, -most, exist_of_all, -most_of_all);
    assert_true(4 * exist > TRIANGLES / 8 && most < 0.0L);
    assert_true(exist_of_all >= exist && most_of_all < 0.0L);
}

/* Makes a triangle at rest whose normal has an angle to z in a direction. */
static moving_triangle tilted_triangle(double angle, double direction) {
    double c = cos(direction), d = sin(direction), e = cos(angle), f = sin(angle);
    moving_triangle m = {{0, 0, 0, c * e, d * e, -f, -d, c, 0}, {0}};
    memcpy(m.x1, m.x0, sizeof m.x1);
    return m;
}

/* Half the angle between two normals varies up to a right angle and beyond, where the bound on an angle
 * from its chord matters. */
TEST(opposite_normals_have_no_cone) {
    const double right = 1.57079632679489662;
    random_stream random = stream_start(4);
    uint32_t exist = 0;
    for (int i = 0; i < TRIANGLES; i++) {
        double angle = right + stream_between(&random, i % 2 == 0 ? -1e-3 : -0.5, 5e-4);
        double direction = stream_between(&random, 0.0, 6.3);
        moving_triangle m[2] = {tilted_triangle(angle, direction), tilted_triangle(-angle, direction)};
        normal_cone a = cone_of(&m[0]), b = cone_of(&m[1]);
        const normal_cone both[2] = {union_of(&a, &b), cone_of_all(m, 2)};
        for (int way = 0; way < 2; way++) {
            assert_true(angle > 1.569 || normal_cone_exists(&both[way]));
            if (!normal_cone_exists(&both[way])) continue;
            exist++;
            assert_true(way == 1 ||
                        angle < (double)normal_cone_limit); /* that of all may look the other way */
            for (int j = 0; j < 2; j++) assert_true(excess_angle(&both[way], &m[j]) < 0.0L);
        }
    }
    assert_true(exist > TRIANGLES);
}

TEST(scales_change_no_cone) {
    random_stream random = stream_start(5);
    uint32_t same = 0;
    for (int i = 0; i < 50; i++) {
        moving_triangle m = random_triangle(&random, 0.1);
        normal_cone cone = cone_of(&m);
        if (!normal_cone_exists(&cone)) continue;
        for (int power = -330; power <= 300; power++) {
            moving_triangle scaled;
            for (int k = 0; k < 9; k++) {
                scaled.x0[k] = ldexp(m.x0[k], power);
                scaled.x1[k] = ldexp(m.x1[k], power);
            }
            normal_cone other = cone_of(&scaled);
            bool exists = normal_cone_exists(&other);
            assert_true(exists || power < -200 || power > 200);
            assert_true(!exists || (power > -260 && power < 260));
            if (!exists) continue;
            assert_memory_equal(&other, &cone, sizeof cone);
            same++;
        }
    }
    assert_true(same > 400);
}

TEST(without_area_there_is_no_cone) {
    const double flat[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, line[9] = {0, 0, 0, 1, 1, 1, 3, 3, 3};
    const double point[9] = {5, 5, 5, 5, 5, 5, 5, 5, 5}, turned[9] = {0, 0, 0, -1, 0, 0, 0, -1, 0};
    const double over[9] = {0, 0, 0, 0, 1, 0, 1, 0, 0}, steep[9] = {0, 0, 0, 0, 0, 1, 0, 1, 0};
    const double *ends[][2] = {{line, line},  {flat, line},   {line, flat}, {flat, point},
                               {point, flat}, {flat, turned}, {flat, over}};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        normal_cone cone = cone_between(ends[i][0], ends[i][1], false);
        assert_false(normal_cone_exists(&cone));
        normal_cone up = cone_between(flat, flat, false);
        assert_true(normal_cone_exists(&up) && up.angle < 1e-5f);
        cone = union_of(&cone, &up);
        assert_false(normal_cone_exists(&cone));
        cone = union_of(&up, &cone);
        assert_false(normal_cone_exists(&cone));
        moving_triangle among[8];
        for (int j = 0; j < 8; j++) {
            memcpy(among[j].x0, j == 5 ? ends[i][0] : flat, sizeof flat);
            memcpy(among[j].x1, j == 5 ? ends[i][1] : flat, sizeof flat);
        }
        cone = cone_of_all(among, 8);
        assert_false(normal_cone_exists(&cone));
        cone = cone_of_all(among, 5);
        assert_true(normal_cone_exists(&cone) && cone.angle < 1e-5f);
    }
    normal_cone quarter = cone_between(flat, steep, false);
    assert_true(normal_cone_exists(&quarter) && quarter.angle > 0.785398f && quarter.angle < 0.792f);
}

AROUND_ALL(open_levels, close_levels)
