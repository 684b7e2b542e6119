/* The potential of a triangle: against quadrature, known values, and the laws that it obeys. */
#include "preprocess/charge/charge.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

typedef long double real;

static double potential_of(const double corners[3][3], const double p[3]) {
    potential_source source;
    double value = -1.0;
    assert_true(potential_source_set(&source, corners));
    potential_at(&source, &p[0], &p[1], &p[2], 1, &value);
    assert_true(isfinite(value));
    return value;
}

static void assert_close(double value, real expected, real tolerance) {
    real error = fabsl((real)value - expected);
    if (!(error <= tolerance * fabsl(expected)))
        fail_msg("%.17g, expected %.17Lg: relative error %Lg", value, expected, error / fabsl(expected));
}

static void random_triangle(double corners[3][3]) {
    potential_source source;
    do {
        for (int i = 0; i < 9; i++) corners[i / 3][i % 3] = random_unit();
        assert_true(potential_source_set(&source, corners));
    } while (source.area < 0.1);
}

/* Computes a p0 + b p1 + (1 - a - b) p2 + h (0.3, 0.5, -0.8). */
static void place_point(const double corners[3][3], double a, double b, double h, double out[3]) {
    const double off[3] = {0.3, 0.5, -0.8};
    for (int k = 0; k < 3; k++)
        out[k] = corners[2][k] + a * (corners[0][k] - corners[2][k]) + b * (corners[1][k] - corners[2][k]) +
                 h * off[k];
}

/* ---- references ---- */

/* Triangles are split until they are small against their distance; then the midpoint rule of seven points of
 * degree five (Radon). */
static real by_quadrature(const real c[3][3], const real p[3], int depth) {
    static const real weights[3] = {0.225L, 0.132394152788506180737L, 0.125939180544827152596L};
    static const real near[3] = {1.0L / 3.0L, 0.470142064105115089770L, 0.101286507323456338800L};
    real centre[3], size = 0.0L, distance = 0.0L, e[2][3];
    for (int k = 0; k < 3; k++) {
        centre[k] = (c[0][k] + c[1][k] + c[2][k]) / 3.0L - p[k];
        e[0][k] = c[1][k] - c[0][k];
        e[1][k] = c[2][k] - c[0][k];
        distance += centre[k] * centre[k];
        size += e[0][k] * e[0][k] + e[1][k] * e[1][k];
    }
    if (size * 144.0L > distance && depth > 0) {
        real m[3][3], sum = 0.0L;
        for (int i = 0; i < 9; i++) m[i / 3][i % 3] = (c[i / 3][i % 3] + c[(i / 3 + 1) % 3][i % 3]) / 2.0L;
        for (int i = 0; i < 3; i++) {
            real part[3][3];
            memcpy(part[0], c[i], sizeof part[0]);
            memcpy(part[1], m[i], sizeof part[1]);
            memcpy(part[2], m[(i + 2) % 3], sizeof part[2]);
            sum += by_quadrature((const real(*)[3])part, p, depth - 1);
        }
        return sum + by_quadrature((const real(*)[3])m, p, depth - 1);
    }
    real n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                 e[0][0] * e[1][1] - e[0][1] * e[1][0]};
    real area = sqrtl(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2.0L, sum = weights[0] / sqrtl(distance);
    for (int i = 0; i < 6; i++) {
        real w = near[1 + i / 3], own = 1.0L - 2.0L * w, squared = 0.0L;
        for (int k = 0; k < 3; k++) {
            real q = own * c[i % 3][k] + w * (c[(i + 1) % 3][k] + c[(i + 2) % 3][k]) - p[k];
            squared += q * q;
        }
        sum += weights[1 + i / 3] / sqrtl(squared);
    }
    return sum * area;
}

static real surface_reference(double corners[3][3], const double p[3]) {
    real c[3][3], q[3];
    for (int i = 0; i < 9; i++) c[i / 3][i % 3] = (real)corners[i / 3][i % 3];
    for (int k = 0; k < 3; k++) q[k] = (real)p[k];
    return by_quadrature((const real(*)[3])c, q, 7);
}

/* The radial part of the integral done by hand: along an edge at distance t from the point's projection,
 * (sqrt(t^2 + l^2 + d^2) - |d|) t / (t^2 + l^2) dl, here with l = p sinh(w) and 16-point Gauss rules. */
static real edge_integral(real t, real d, real from, real to) {
    static const real x[8] = {0.0950125098376374402L, 0.2816035507792589132L, 0.4580167776572273863L,
                              0.6178762444026437485L, 0.7554044083550030339L, 0.8656312023878317439L,
                              0.9445750230732325761L, 0.9894009349916499326L};
    static const real w[8] = {0.1894506104550684963L, 0.1826034150449235889L, 0.1691565193950025382L,
                              0.1495959888165767321L, 0.1246289712555338720L, 0.0951585116824927848L,
                              0.0622535239386478929L, 0.0271524594117540949L};
    enum { PIECES = 200 };
    real p = sqrtl(t * t + d * d);
    if (t == 0.0L) return 0.0L;
    real begin = asinhl(from / p), step = (asinhl(to / p) - begin) / PIECES, sum = 0.0L;
    for (int i = 0; i < PIECES * 16; i++) {
        real node = i % 16 < 8 ? x[i % 8] : -x[i % 8];
        real l = p * sinhl(begin + step * (real)(i / 16) + step * 0.5L * (1.0L + node));
        real r = sqrtl(p * p + l * l);
        sum += w[i % 8] * t / (r + fabsl(d)) * r; /* sqrt - |d| = (t^2 + l^2) / (r + |d|) */
    }
    return sum * step / 2.0L;
}

static real real_dot(const real a[3], const real b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void real_cross(const real a[3], const real b[3], real out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void real_normalise(real a[3]) {
    real length = sqrtl(real_dot(a, a));
    for (int k = 0; k < 3; k++) a[k] /= length;
}

static real by_edges(const double corners[3][3], const double point[3]) {
    real to[3][3], along[3][3], n[3], sum = 0.0L;
    for (int i = 0; i < 9; i++) to[i / 3][i % 3] = (real)corners[i / 3][i % 3] - (real)point[i % 3];
    for (int i = 0; i < 9; i++)
        along[i / 3][i % 3] = (real)corners[(i / 3 + 1) % 3][i % 3] - (real)corners[i / 3][i % 3];
    real_cross(along[0], along[1], n);
    real_normalise(n);
    real slant = real_dot(n, along[0]) /
                 real_dot(along[0], along[0]); /* rounding that a sliver with a long edge 0 shows */
    for (int k = 0; k < 3; k++) n[k] -= slant * along[0][k];
    for (int i = 0; i < 3; i++) {
        real outward[3], length = sqrtl(real_dot(along[i], along[i]));
        real_normalise(along[i]);
        real_cross(along[i], n, outward);
        real from = real_dot(along[i], to[i]);
        sum += edge_integral(real_dot(outward, to[i]), real_dot(n, to[i]), from, from + length);
    }
    return sum;
}

/* ---- tests ---- */

TEST(agrees_with_surface_quadrature) {
    random_seed(1);
    for (int round = 0; round < 40; round++) {
        double corners[3][3], p[3];
        random_triangle(corners);
        place_point((const double(*)[3])corners, random_unit(), random_unit(), random_between(0.05, 2.0), p);
        real expected = surface_reference(corners, p);
        assert_close(potential_of((const double(*)[3])corners, p), expected, 1e-7L);
        assert_close((double)by_edges((const double(*)[3])corners, p), expected, 1e-7L);
    }
}

/* The weights a and b and the height of a place, and the relative error that is allowed there. */
TEST(agrees_with_edge_quadrature) {
    static const struct {
        const char *name;
        double a, b, height;
        real tolerance;
    } places[] = {{"above", 0.3, 0.4, 0.7, 1e-13L},
                  {"centroid", 1.0 / 3.0, 1.0 / 3.0, 0.0, 1e-13L},
                  {"just above the centroid", 1.0 / 3.0, 1.0 / 3.0, 1e-9, 1e-13L},
                  {"in the plane, outside", 1.7, -0.3, 0.0, 1e-13L},
                  {"on an edge", 0.3, 0.7, 0.0, 1e-13L},
                  {"on an edge's line", 1.9, -0.9, 0.0, 1e-13L},
                  {"above an edge", 0.4, 0.6, 0.6, 1e-13L},
                  {"near an edge", 0.4, 0.6, 1e-9, 1e-13L},
                  {"very near an edge", 0.4, 0.6, 1e-15, 1e-13L},
                  {"a corner", 0.0, 0.0, 0.0, 1e-13L},
                  {"above a corner", 1.0, 0.0, 0.4, 1e-13L},
                  {"near a corner", 1.0, 1e-10, 1e-10, 1e-13L},
                  {"far", 20.0, -30.0, 40.0, 1e-12L},
                  {"farther", 200.0, -300.0, 400.0, 1e-11L}};
    random_seed(2);
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        for (int round = 0; round < 8; round++) {
            double corners[3][3], p[3];
            random_triangle(corners);
            place_point((const double(*)[3])corners, places[i].a, places[i].b, places[i].height, p);
            real expected = by_edges((const double(*)[3])corners, p);
            assert_close(potential_of((const double(*)[3])corners, p), expected, places[i].tolerance);
        }
    }
}

/* There the seven-point rule is all but exact, while the sum over the edges cancels. */
TEST(agrees_with_surface_quadrature_far_away) {
    random_seed(9);
    for (int round = 0; round < 60; round++) {
        double corners[3][3], p[3], distance = pow(10.0, 2.5 + round * 0.1);
        random_triangle(corners);
        place_point((const double(*)[3])corners, distance * random_unit(), distance * random_unit(), distance,
                    p);
        assert_close(potential_of((const double(*)[3])corners, p), surface_reference(corners, p),
                     1e-11L + 1e-14L * (real)distance);
    }
}

TEST(known_values) {
    const double h = sqrt(0.75);
    const double equilateral[3][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}}, centroid[3] = {0.5, h / 3.0, 0};
    const double right[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, corner[3] = {0, 0, 0};
    assert_close(potential_of(equilateral, centroid), sqrtl(3.0L) * logl(2.0L + sqrtl(3.0L)), 1e-15L);
    assert_close(potential_of(right, corner), sqrtl(2.0L) * logl(1.0L + sqrtl(2.0L)), 1e-15L);
}

TEST(potential_of_slivers) {
    random_seed(3);
    for (int round = 0; round < 60; round++) {
        double width = pow(10.0, random_between(-8.0, -2.0)), p[3];
        double corners[3][3] = {{-0.4, 0.3, 0.1}, {0.5, -0.2, 0.3}, {0, 0, 0}};
        place_point((const double(*)[3])corners, 0.3, 0.3, 0.0, corners[2]);
        for (int k = 0; k < 3; k++) corners[2][k] = 0.35 * corners[0][k] + 0.65 * corners[1][k];
        corners[2][1] += width;
        double near = width * random_between(0.1, 4.0) * (round % 3); /* 0: on the long edge */
        for (int k = 0; k < 3; k++) p[k] = 0.5 * (corners[0][k] + corners[1][k]) + near * random_unit();
        assert_close(potential_of((const double(*)[3])corners, p), by_edges((const double(*)[3])corners, p),
                     1e-15L / (real)width + 1e-12L);
    }
}

TEST(without_area) {
    potential_source source, before;
    memset(&source, 7, sizeof source);
    before = source;
    const double none[4][3][3] = {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}},
                                  {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}},
                                  {{0.1, 0.2, 0.3}, {0.4, 0.8, 1.2}, {0.1, 0.2, 0.3}},
                                  {{0.1, 0.2, 0.3}, {0.2, 0.4, 0.6}, {0.7, 1.4, 2.1}}};
    for (int i = 0; i < 4; i++) assert_false(potential_source_set(&source, none[i]));
    assert_memory_equal(&source, &before, sizeof source);
}

TEST(scales_with_length) {
    random_seed(4);
    for (int round = 0; round < 50; round++) {
        double corners[3][3], p[3], scaled[3][3], q[3];
        random_triangle(corners);
        place_point((const double(*)[3])corners, random_unit(), random_unit(),
                    round % 2 ? random_unit() : 0.0, p);
        double value = potential_of((const double(*)[3])corners, p);
        const double factors[4] = {0x1p40, 0x1p-40, 0x1p3, 3.7};
        for (int f = 0; f < 4; f++) {
            for (int i = 0; i < 9; i++) scaled[i / 3][i % 3] = corners[i / 3][i % 3] * factors[f];
            for (int k = 0; k < 3; k++) q[k] = p[k] * factors[f];
            double expected = value * factors[f], found = potential_of((const double(*)[3])scaled, q);
            if (f < 3)
                assert_true(found == expected);
            else
                assert_close(found, (real)expected, 1e-13L);
        }
    }
}

/* Coordinates that are multiples of 2^-20 stay exact when moved by 10^6: so does the result. */
TEST(far_from_the_origin) {
    random_seed(5);
    for (int round = 0; round < 50; round++) {
        double here[3][3], there[3][3], p[3], q[3];
        const double offset[3] = {1e6, -1e6, 5e5};
        random_triangle(here);
        for (int k = 0; k < 3; k++) {
            p[k] = ldexp(random_integer(-2000000, 2000000), -20);
            q[k] = p[k] + offset[k];
            for (int i = 0; i < 3; i++) {
                here[i][k] = ldexp(rint(ldexp(here[i][k], 20)), -20);
                there[i][k] = here[i][k] + offset[k];
            }
        }
        assert_true(potential_of((const double(*)[3])here, p) == potential_of((const double(*)[3])there, q));
    }
}

TEST(does_not_depend_on_the_frame) {
    random_seed(6);
    for (int round = 0; round < 50; round++) {
        double corners[3][3], turned[3][3], p[3], q[3];
        random_triangle(corners);
        place_point((const double(*)[3])corners, random_unit(), random_unit(),
                    round % 2 ? random_unit() : 0.0, p);
        double value = potential_of((const double(*)[3])corners, p), angle = 4.0 * random_unit();
        const double axes[3][3] = {{cos(angle), -sin(angle), 0.0},
                                   {0.6 * sin(angle), 0.6 * cos(angle), -0.8},
                                   {0.8 * sin(angle), 0.8 * cos(angle), 0.6}};
        for (int k = 0; k < 3; k++) {
            q[k] = axes[k][0] * p[0] + axes[k][1] * p[1] + axes[k][2] * p[2] + k;
            for (int i = 0; i < 3; i++) /* the corners' order and direction change too */
                turned[(round + (round % 4 < 2 ? i : 2 * i)) % 3][k] =
                    axes[k][0] * corners[i][0] + axes[k][1] * corners[i][1] + axes[k][2] * corners[i][2] + k;
        }
        assert_close(potential_of((const double(*)[3])turned, q), (real)value, 1e-12L);
    }
}

TEST(parts_add_up) {
    random_seed(7);
    for (int round = 0; round < 50; round++) {
        double corners[3][3], middles[3][3], p[3], sum = 0.0;
        random_triangle(corners);
        place_point((const double(*)[3])corners, random_unit(), random_unit(),
                    round % 2 ? random_unit() : 0.0, p);
        for (int i = 0; i < 9; i++)
            middles[i / 3][i % 3] = 0.5 * (corners[i / 3][i % 3] + corners[(i / 3 + 1) % 3][i % 3]);
        for (int i = 0; i < 3; i++) {
            double part[3][3];
            memcpy(part[0], corners[i], sizeof part[0]);
            memcpy(part[1], middles[i], sizeof part[1]);
            memcpy(part[2], middles[(i + 2) % 3], sizeof part[2]);
            sum += potential_of((const double(*)[3])part, p);
        }
        sum += potential_of((const double(*)[3])middles, p);
        assert_close(sum, (real)potential_of((const double(*)[3])corners, p), 1e-13L);
    }
}

/* Vectors, their remainders and single points give the same bits. */
TEST(many_points_at_once) {
    enum { COUNT = 61 };
    double corners[3][3], points[3][COUNT], together[COUNT + 1];
    potential_source source;
    random_seed(8);
    random_triangle(corners);
    assert_true(potential_source_set(&source, (const double(*)[3])corners));
    for (int i = 0; i < COUNT; i++) {
        double p[3];
        place_point((const double(*)[3])corners, random_unit(), random_unit(), i % 3 ? random_unit() : 0.0,
                    p);
        for (int k = 0; k < 3; k++) points[k][i] = i < 3 ? corners[i][k] : p[k];
    }
    for (size_t count = 1; count <= COUNT; count += 3) {
        together[count] = -7.0;
        potential_at(&source, points[0], points[1], points[2], count, together);
        assert_true(together[count] == -7.0);
        for (size_t i = 0; i < count; i++) {
            double p[3] = {points[0][i], points[1][i], points[2][i]};
            assert_true(together[i] == potential_of((const double(*)[3])corners, p));
        }
    }
}
