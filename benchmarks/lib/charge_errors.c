/* Errors of charges, relative, beside what is known otherwise of bodies of models/shapes. */
#include "benchmarks/lib/charge_trial.h"

#include <math.h>
#include <stdlib.h>

/* ---- what is known ------------------------------------------------------------------------------------- */

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

/* ---- the table ----------------------------------------------------------------------------------------- */

enum { SOLVER_COUNT = 3, DENSE_ERRORS_MOST = 5000 };

static const body_kind kinds[] = {BODY_SPHERE, BODY_ELLIPSOID, BODY_TORUS, BODY_CUBE};
static const cscd_charge_solver solvers[SOLVER_COUNT] = {CSCD_CHARGE_DENSE, CSCD_CHARGE_TREE,
                                                         CSCD_CHARGE_COARSE};

/* Relative errors; those of the densities NAN where they are not known. */
typedef struct error_row {
    uint32_t triangles;
    double capacitance, largest, mean_square;
} error_row;

static void centroid_of(const body *b, uint32_t triangle, double out[3]) {
    const uint32_t *v = b->triangles + (size_t)triangle * 3;
    for (int k = 0; k < 3; k++)
        out[k] = (b->positions[(size_t)v[0] * 3 + (size_t)k] + b->positions[(size_t)v[1] * 3 + (size_t)k] +
                  b->positions[(size_t)v[2] * 3 + (size_t)k]) /
                 3.0;
}

static error_row find_errors(body_kind kind, const body *b, const charge_trial *t, const double *density) {
    error_row r = {b->triangle_count, fabs(t->capacitance / exact_capacitance(kind) - 1.0), NAN, NAN};
    if (!has_exact_density(kind)) return r;
    double sum = 0.0;
    r.largest = 0.0;
    for (uint32_t i = 0; i < b->triangle_count; i++) {
        double centroid[3];
        centroid_of(b, i, centroid);
        const double difference = fabs(density[i] / exact_density(kind, centroid) - 1.0);
        r.largest = fmax(r.largest, difference);
        sum += difference * difference;
    }
    r.mean_square = sqrt(sum / b->triangle_count);
    return r;
}

/* The exponent of the triangles' size; NAN without a row before. */
static double order_of(const error_row *before, const error_row *now, double error_before, double error_now) {
    return before->triangles > 0
               ? 2.0 * log(error_before / error_now) / log((double)now->triangles / (double)before->triangles)
               : NAN;
}

/* ---- rows ------------------------------------------------------------------------------------------------ */

/* A number, or a dash for NAN. */
static void print_cell(int width, const char *format, double value) {
    char text[32] = "-";
    if (!isnan(value)) snprintf(text, sizeof text, format, value);
    printf(" %*s", width, text);
}

static void print_titles(void) {
    printf("\nerrors, relative\n  %-10s %9s %-7s %12s %9s %6s %9s %6s %9s %6s %4s %9s %9s\n", "body",
           "triangles", "solver", "capacitance", "its error", "order", "largest", "order", "rms", "order",
           "its", "seconds", "peak MiB");
}

static void print_row(body_kind kind, cscd_charge_solver solver, const error_row *before,
                      const error_row *now, const charge_trial *t) {
    printf("  %-10s %9u %-7s %12.9f", body_kind_name(kind), now->triangles, charge_solver_name(solver),
           t->capacitance);
    print_cell(9, "%.2e", now->capacitance);
    print_cell(6, "%.2f", order_of(before, now, before->capacitance, now->capacitance));
    print_cell(9, "%.2e", now->largest);
    print_cell(6, "%.2f", order_of(before, now, before->largest, now->largest));
    print_cell(9, "%.2e", now->mean_square);
    print_cell(6, "%.2f", order_of(before, now, before->mean_square, now->mean_square));
    printf(" %4u %9.3f %9.1f\n", t->iterations, t->total_ms / 1e3, t->peak_bytes / 0x1p20);
    fflush(stdout);
}

static void write_row(json *out, body_kind kind, cscd_charge_solver solver, const error_row *now,
                      const charge_trial *t) {
    if (!charge_row_begin(out, "errors", body_kind_name(kind), now->triangles, solver)) return;
    json_number(out, "capacitance", t->capacitance);
    json_number(out, "exact", exact_capacitance(kind));
    json_number(out, "capacitance_error", now->capacitance);
    json_number(out, "density_largest", now->largest);
    json_number(out, "density_rms", now->mean_square);
    charge_row_end(out, t);
}

/* ---- the table ------------------------------------------------------------------------------------------- */

static bool run_solver(body_kind kind, const body *b, cscd_charge_solver solver, error_row *before, json *out,
                       io_error *error) {
    const charge_request request = {solver, 1, false};
    charge_trial t;
    double *density = body_allocate(b->triangle_count, sizeof *density);
    bool good = charge_trial_run(b, &request, &t, density, error) &&
                (t.status == CSCD_OK || io_fail(error, "%s", t.detail));
    if (good) {
        const error_row now = find_errors(kind, b, &t, density);
        print_row(kind, solver, before, &now, &t);
        write_row(out, kind, solver, &now, &t);
        *before = now;
    }
    free(density);
    return good;
}

static bool run_size(body_kind kind, uint32_t triangles, const charge_limits *limits,
                     error_row before[SOLVER_COUNT], json *out, io_error *error) {
    body b;
    if (!body_make(kind, body_nearest_count(kind, triangles), &b, error)) return false;
    bool good = true;
    for (int i = 0; good && i < SOLVER_COUNT; i++) {
        if (solvers[i] == CSCD_CHARGE_DENSE &&
            (b.triangle_count > limits->dense_most || b.triangle_count > DENSE_ERRORS_MOST))
            continue;
        good = run_solver(kind, &b, solvers[i], &before[i], out, error);
    }
    body_free(&b);
    return good;
}

bool charge_print_errors(const charge_limits *limits, json *out, io_error *error) {
    static const uint32_t sizes[] = {1000, 4000, 10000, 100000, 1000000};
    bool good = true;
    print_titles();
    for (size_t k = 0; good && k < sizeof kinds / sizeof *kinds; k++) {
        error_row before[SOLVER_COUNT] = {{0, NAN, NAN, NAN}};
        for (size_t i = 0; good && i < sizeof sizes / sizeof *sizes; i++)
            if (sizes[i] <= limits->most) good = run_size(kinds[k], sizes[i], limits, before, out, error);
    }
    return good;
}
