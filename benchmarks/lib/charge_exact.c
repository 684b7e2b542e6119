/* Bodies of models/shapes as conductors whose charge is known otherwise: sphere, ellipsoid, torus, and the cube's capacitance. */
#include "benchmarks/lib/charge_exact.h"

#include <math.h>

enum { AXIS_COUNT = 3, HARMONICS = 40, NODES = 256 };

static const double pi = 0x1.921fb54442d18p+1;

/* The sizes of models/shapes/catalogue.h. */
static const double half_axes[AXIS_COUNT] = {1.5, 1.0, 0.7};
static const double ring_radius = 1.0, tube_radius = 0.35, cube_edge = 2.0;

/* For edge 1: Hwang, Mascagni, Electrical capacitance of the unit cube, J. Appl. Phys. 95, 2004; to this
 * number of digits Helsing, Perfekt, On the polarizability and capacitance of the cube, Appl. Comput. Harmon.
 * Anal. 34, 2013. */
static const double unit_cube_capacitance = 0.66067815409957;

/* ---- ellipsoid ------------------------------------------------------------------------------------------- */

/* Carlson's R_F by duplication: 1 / R_F(a^2, b^2, c^2) is the capacitance of an ellipsoid. */
static double carlson_rf(double x, double y, double z) {
    for (int i = 0; i < 40; i++) {
        const double shift = sqrt(x) * sqrt(y) + sqrt(y) * sqrt(z) + sqrt(z) * sqrt(x);
        x = 0.25 * (x + shift);
        y = 0.25 * (y + shift);
        z = 0.25 * (z + shift);
    }
    return 1.0 / sqrt((x + y + z) / 3.0);
}

static double ellipsoid_capacitance(void) {
    const double *a = half_axes;
    return 1.0 / carlson_rf(a[0] * a[0], a[1] * a[1], a[2] * a[2]);
}

/* C / (4 pi a b c) / sqrt(x^2 / a^4 + y^2 / b^4 + z^2 / c^4) where the ray from the middle meets the surface. */
static double ellipsoid_density(const double point[3]) {
    const double *a = half_axes;
    double norm = 0.0, sum = 0.0;
    for (int k = 0; k < AXIS_COUNT; k++) {
        const double share = point[k] / a[k];
        norm += share * share;
        sum += share * share / (a[k] * a[k]);
    }
    return ellipsoid_capacitance() / (4.0 * pi * a[0] * a[1] * a[2]) / sqrt(sum / norm);
}

/* ---- torus ----------------------------------------------------------------------------------------------- */

/* Toroidal coordinates (Hobson 1931; Morse, Feshbach 1953): the torus is eta = eta0, where cosh(eta0) is the ring's radius over that of
 * the tube, and theta runs around the tube. With P_n and Q_n the Legendre functions of degree n - 1/2 at cosh(eta0), and every
 * sum's first term halved, C = 4 a / pi * sum of Q_n / P_n. The density is the derivative of the potential's series; Wronski's
 * determinant of P_n and Q_n leaves of it
 *     (cosh(eta0) - cos(theta))^(3/2) / (sqrt(2) pi^2 a sinh(eta0)) * sum of cos(n theta) / P_n.
 * 1 / P_n falls as exp(-n eta0), to 1e-29 in the last term. */
typedef struct torus_series {
    double focus, cosine, sine;                 /* a, cosh(eta0), sinh(eta0) */
    double first[HARMONICS], second[HARMONICS]; /* P_n, Q_n */
} torus_series;

/* P_n is the mean of (cosh + sinh cos(phi))^(n - 1/2), and Q_n the integral of cos(n theta) / sqrt(2 cosh - 2 cos(theta)), both
 * over half a circle: sums over even steps converge exponentially. */
static torus_series make_torus_series(void) {
    torus_series s = {.cosine = ring_radius / tube_radius};
    s.sine = sqrt(s.cosine * s.cosine - 1.0);
    s.focus = sqrt(ring_radius * ring_radius - tube_radius * tube_radius);
    for (int n = 0; n < HARMONICS; n++) {
        for (int i = 0; i < NODES; i++) {
            const double angle = pi * (i + 0.5) / NODES, c = cos(angle);
            s.first[n] += pow(s.cosine + s.sine * c, n - 0.5) / NODES;
            s.second[n] += cos(n * angle) / sqrt(2.0 * (s.cosine - c)) * pi / NODES;
        }
    }
    return s;
}

static double torus_capacitance(void) {
    const torus_series s = make_torus_series();
    double sum = 0.5 * s.second[0] / s.first[0];
    for (int n = 1; n < HARMONICS; n++) sum += s.second[n] / s.first[n];
    return 4.0 * s.focus / pi * sum;
}

/* The point's place around the tube decides. */
static double torus_density(const double point[3]) {
    static torus_series s;
    if (s.focus == 0.0) s = make_torus_series();
    const double out = hypot(point[0], point[1]) - ring_radius;
    const double distance = ring_radius + tube_radius * out / hypot(out, point[2]);
    const double c = fmin(fmax(s.cosine - s.focus * s.sine / distance, -1.0), 1.0), theta = acos(c);
    double sum = 0.5 / s.first[0];
    for (int n = 1; n < HARMONICS; n++) sum += cos(n * theta) / s.first[n];
    return pow(s.cosine - c, 1.5) / (sqrt(2.0) * pi * pi * s.focus * s.sine) * sum;
}

/* ---- all ------------------------------------------------------------------------------------------------- */

double exact_capacitance(body_kind kind) {
    switch (kind) {
    case BODY_SPHERE:
        return 1.0;
    case BODY_ELLIPSOID:
        return ellipsoid_capacitance();
    case BODY_TORUS:
        return torus_capacitance();
    case BODY_CUBE:
        return cube_edge * unit_cube_capacitance;
    default:
        return NAN;
    }
}

bool has_exact_density(body_kind kind) {
    return kind == BODY_SPHERE || kind == BODY_ELLIPSOID || kind == BODY_TORUS;
}

double exact_density(body_kind kind, const double point[3]) {
    switch (kind) {
    case BODY_SPHERE:
        return 1.0 / (4.0 * pi);
    case BODY_ELLIPSOID:
        return ellipsoid_density(point);
    case BODY_TORUS:
        return torus_density(point);
    default:
        return NAN;
    }
}
