/* Capacitances and densities of bodies whose charge is known otherwise: their errors, and the order with which these fall. */
#include "benchmarks/lib/charge_exact.h"
#include "benchmarks/lib/charge_tables.h"

#include <math.h>
#include <stdlib.h>

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
