/* What is told of a touch, where features are far smaller than their motion, or needles. */
#include "runtime/ccd/ccd.h"
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/test.h"

#include <math.h>

static double vector_length(const double v[3]) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void check_normal(const elementary_contact *hit, double x, double y, double z) {
    double size = sqrt(x * x + y * y + z * z);
    assert_true(fabs(vector_length(hit->normal) - 1.0) < 1e-14);
    assert_true(fabs(hit->normal[0] * x + hit->normal[1] * y + hit->normal[2] * z) > (1.0 - 1e-12) * size);
}

/* A vertex falls through the middle of a face that is tiny beside the way that it falls. */
TEST(tiny_face_at_rest) {
    for (int exponent = 0; exponent >= -290; exponent -= 10) {
        double s = ldexp(1.3, exponent);
        const elementary_query query = {{{s / 4, s / 4, 1}, {0, 0, 0}, {s, 0, 0}, {0, s, 0}},
                                        {{s / 4, s / 4, -1}, {0, 0, 0}, {s, 0, 0}, {0, s, 0}}};
        elementary_contact hit;
        assert_true(pair_test(CSCD_CONTACT_VF, &query, &hit).touching);
        assert_true(fabs(hit.u - 0.25) < 1e-12 && fabs(hit.v - 0.25) < 1e-12);
        check_normal(&hit, 0, 0, 1);
    }
}

/* It crosses a tilted face at an angle: where along the face depends on the last bits of the time. */
TEST(tiny_face_hit_aslant) {
    for (int exponent = 0; exponent >= -60; exponent -= 4) {
        double s = ldexp(1.3, exponent);
        const elementary_query query = {{{1, 1, 1}, {0, 0, 0}, {s, 0, -s}, {0, s, s}},
                                        {{s / 2 - 1, s / 2 - 1, -1}, {0, 0, 0}, {s, 0, -s}, {0, s, s}}};
        elementary_contact hit;
        if (pair_test(CSCD_CONTACT_VF, &query, &hit).touching) check_normal(&hit, 1, -1, 1);
    }
}

/* Edges of very different lengths. */
TEST(tiny_edge_on_a_long_one) {
    for (int exponent = 0; exponent >= -250; exponent -= 10) {
        double s = ldexp(1.5, exponent);
        const elementary_query query = {{{-1, 0, 0}, {1, 0, 0}, {0, -s, 1}, {0, s, 1}},
                                        {{-1, 0, 0}, {1, 0, 0}, {0, -s, -1}, {0, s, -1}}};
        elementary_contact hit;
        assert_true(pair_test(CSCD_CONTACT_EE, &query, &hit).touching);
        assert_true(fabs(hit.u - 0.5) < 1e-12 && fabs(hit.v - 0.5) < 1e-12);
        check_normal(&hit, 0, 0, 1);
    }
}

/* The points named lie within 1e-8 of the largest displacement and 64 units in the last place. */
TEST(needle_face) {
    static const elementary_query query = {
        {{-0x1.0b3a2d5415da1p-28, 0x1.03d08ac0a6fc9p-26, -0x1.a528fade0f952p-27},
         {-0x1.a6327cc1c6dfdp-2, 0x1.1f34b0eb52138p-3, -0x1.4cf47b36b12fp-4},
         {0x1.b15c7a85431ddp-3, -0x1.26ccea5e27a2ap-4, 0x1.55c25c35afb9ep-5},
         {-0x1.f93b130f4b5e5p-4, 0x1.57b0d75fceecp-5, -0x1.8e6fecff23eccp-6}},
        {{-0x1.0b3a2d5415dap-80, 0x1.03d08ac0a6fc8p-78, -0x1.a528fade0f95p-79},
         {-0x1.a6327cf48d982p-2, 0x1.1f34b2ca2684fp-3, -0x1.4cf4735774bcdp-4},
         {0x1.b15c7aa8d8b2cp-3, -0x1.26cce383e49fap-4, 0x1.55c254bf46f66p-5},
         {-0x1.f93b0d09fbdcp-4, 0x1.57b0c982c252cp-5, -0x1.8e6fe32e498d6p-6}}};
    elementary_contact hit;
    assert_true(pair_test(CSCD_CONTACT_VF, &query, &hit).touching);
    long double squared = 0, t = hit.toi;
    for (int k = 0; k < 3; k++) {
        long double p[4];
        for (int i = 0; i < 4; i++) p[i] = (1 - t) * query.x0[i][k] + t * query.x1[i][k];
        long double apart = p[0] - p[1] - hit.u * (p[2] - p[1]) - hit.v * (p[3] - p[1]);
        squared += apart * apart;
    }
    assert_true(sqrtl(squared) <= 3.7e-15L);
}

/* Edges at an angle of 2^-32 pass at twice the distance: not reported, and not given up. */
TEST(nearly_parallel_edges) {
    static const elementary_query query = {
        {{0x1.4734f78ac82c5p-5, 0x1.30426583bee47p-4, -0x1.144c252fea1b7p-8},
         {-0x1.c719d247dbf6fp-3, -0x1.a7328eb9654cep-2, 0x1.80556a0d82512p-6},
         {0x1.fc95e94b00fefp-5, 0x1.d8ee3751e1a69p-4, -0x1.ad7ea03d5de6dp-8},
         {-0x1.63ea232af4ca2p-4, -0x1.4af6761bb8b18p-3, 0x1.2c90d50a1d6p-7}},
        {{0x1.473537b6e4df9p-5, 0x1.30425d0280ce9p-4, -0x1.145042a6a6cc4p-8},
         {-0x1.c719cc063b699p-3, -0x1.a732b3a4035b9p-2, 0x1.8058895775f79p-6},
         {0x1.fc949e0f6fe6ep-5, 0x1.d8edc6f55fa1p-4, -0x1.ad772d2e0a9e4p-8},
         {-0x1.63eb0ef2df2afp-4, -0x1.4af68b8756b18p-3, 0x1.2c944217c5372p-7}}};
    const separation limit = {0x1.0c6f7a0b5ed8dp-21, 0x1.19799812dea11p-41};
    elementary_contact hit;
    bool bounded;
    assert_false(separation_ee(&query, &limit, &hit, &bounded));
}

/* Beside each side of a face, a quarter of the way along it, and beyond each corner. */
TEST(nearest_on_the_sides) {
    static const struct {
        double point[3], u, v, squared;
    } known[] = {
        {{1.0, -1.0, 0.0}, 0.25, 0.0, 1.0}, {{4.0, 2.0, 1.0}, 0.75, 0.25, 3.0},
        {{-3.0, 3.0, 0.0}, 0.0, 0.75, 9.0}, {{-1.0, -2.0, 2.0}, 0.0, 0.0, 9.0},
        {{6.0, -1.0, 0.0}, 1.0, 0.0, 5.0},  {{-1.0, 6.0, 0.0}, 0.0, 1.0, 5.0},
    };
    static const double a[3] = {0.0}, b[3] = {4.0, 0.0, 0.0}, c[3] = {0.0, 4.0, 0.0};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double u, v, squared = closest_point_triangle(known[i].point, a, b, c, &u, &v);
        assert_true(u == known[i].u && v == known[i].v && squared == known[i].squared);
    }
}
