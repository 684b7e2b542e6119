/* The tree's charges compared with those of the dense solution: cuts are made of the order of the densities,
 * so that is what must agree. */
#include "benchmarks/lib/charge_trial.h"
#include "benchmarks/lib/density_ranks.h"
#include "models/shapes/catalogue.h"

#include <math.h>
#include <stdlib.h>

/* The task of a solver. */
typedef struct rank_target {
    double correlation, overlap, capacitance; /* NAN: nothing */
} rank_target;

typedef struct rank_row {
    rank_agreement ranks;
    double capacitance; /* relative difference */
    double largest;     /* difference of densities over their mean */
    double mean_square; /* the same, the root of the mean square */
} rank_row;

static void compare_densities_of(const double *exact, const double *density, uint32_t count, rank_row *out) {
    double mean = 0.0, sum = 0.0;
    for (uint32_t t = 0; t < count; t++) mean += exact[t] / count;
    out->largest = 0.0;
    for (uint32_t t = 0; t < count; t++) {
        const double d = fabs(density[t] - exact[t]) / mean;
        out->largest = fmax(out->largest, d);
        sum += d * d;
    }
    out->mean_square = sqrt(sum / count);
}

static bool meets_target(const rank_row *r, const rank_target *target) {
    return r->ranks.correlation >= target->correlation && r->ranks.overlap >= target->overlap &&
           (isnan(target->capacitance) || r->capacitance <= target->capacitance);
}

/* ---- rows ------------------------------------------------------------------------------------------------ */

static void print_row(const char *name, const charge_trial *t, uint32_t triangles, cscd_charge_solver solver,
                      const rank_row *r, const rank_target *target) {
    printf("  %-8s %9u %-7s %9.7f %8.4f %11.2e %9.2e %9.2e %4u %9.3f  %s\n", name, triangles,
           charge_solver_name(solver), r->ranks.correlation, r->ranks.overlap, r->capacitance, r->largest,
           r->mean_square, t->iterations, t->total_ms / 1e3, meets_target(r, target) ? "met" : "missed");
    fflush(stdout);
}

static void write_row(json *out, const char *name, const charge_trial *t, uint32_t triangles,
                      cscd_charge_solver solver, const rank_row *r) {
    if (!charge_row_begin(out, "ranks", name, triangles, solver)) return;
    json_number(out, "correlation", r->ranks.correlation);
    json_number(out, "overlap", r->ranks.overlap);
    json_number(out, "capacitance_difference", r->capacitance);
    json_number(out, "density_largest", r->largest);
    json_number(out, "density_rms", r->mean_square);
    charge_row_end(out, t);
}

/* ---- the table ------------------------------------------------------------------------------------------- */

static bool solve_body(const body *b, cscd_charge_solver solver, charge_trial *out, double *density,
                       io_error *error) {
    const charge_request request = {solver, 1, false};
    return charge_trial_run(b, &request, out, density, error) &&
           (out->status == CSCD_OK || io_fail(error, "%s", out->detail));
}

static bool compare_solvers(const char *name, const body *b, double *exact, double *density, json *out,
                            io_error *error) {
    static const struct {
        cscd_charge_solver solver;
        rank_target target;
    } compared[] = {{CSCD_CHARGE_TREE, {0.999, 0.98, 1e-3}}, {CSCD_CHARGE_COARSE, {0.97, 0.9, NAN}}};
    charge_trial dense, t;
    bool good = solve_body(b, CSCD_CHARGE_DENSE, &dense, exact, error);
    for (int i = 0; good && i < 2; i++) {
        rank_row r;
        const cscd_charge_solver solver = compared[i].solver;
        good = solve_body(b, solver, &t, density, error);
        if (!good) break;
        r.ranks = density_ranks_compare(exact, density, b->triangle_count);
        compare_densities_of(exact, density, b->triangle_count, &r);
        r.capacitance = fabs(t.capacitance / dense.capacitance - 1.0);
        print_row(name, &t, b->triangle_count, solver, &r, &compared[i].target);
        write_row(out, name, &t, b->triangle_count, solver, &r);
    }
    return good;
}

static bool run_body(body_kind kind, uint32_t triangles, json *out, io_error *error) {
    body b;
    if (!body_make(kind, body_nearest_count(kind, triangles), &b, error)) return false;
    double *exact = body_allocate(b.triangle_count, sizeof *exact),
           *density = body_allocate(b.triangle_count, sizeof *density);
    const bool good = compare_solvers(body_kind_name(kind), &b, exact, density, out, error);
    free(exact);
    free(density);
    body_free(&b);
    return good;
}

bool charge_print_ranks(const charge_limits *limits, json *out, io_error *error) {
    static const body_kind kinds[] = {BODY_PAWN, BODY_FIGURE};
    const uint32_t triangles = limits->dense_most < 12800 ? limits->dense_most : 12800;
    bool good = true;
    printf("\nranks: beside the dense solution\n"
           "  asked of tree: correlation 0.999, overlap 0.98, capacitance 1e-3; of coarse: 0.97, 0.9\n"
           "  %-8s %9s %-7s %9s %8s %11s %9s %9s %4s %9s\n",
           "body", "triangles", "solver", "Spearman", "lowest", "capacitance", "largest", "rms", "its",
           "seconds");
    for (size_t i = 0; good && i < sizeof kinds / sizeof *kinds; i++)
        good = run_body(kinds[i], triangles, out, error);
    return good;
}
