/* Hard meshes: solved, and how well, or the sentence that says why not. */
#include "benchmarks/lib/charge_tables.h"
#include "benchmarks/lib/hard_conductors.h"

#include <math.h>

static void print_difference(double value, double other) {
    if (isnan(other))
        printf(" %9s", "-");
    else
        printf(" %9.1e", value / other - 1.0);
}

static void print_row(const hard_conductor *c, const char *solver, const charge_trial *t, double dense) {
    printf("  %-34s %9u %10u %-7s", c->name, c->body.triangle_count, t->components, solver);
    if (t->status != CSCD_OK) {
        printf(" %s after %.3f s: %s\n", cscd_status_string(t->status), t->total_ms / 1e3, t->detail);
        return;
    }
    printf(" %13.8g", t->capacitance);
    print_difference(t->capacitance, c->capacitance);
    print_difference(t->capacitance, dense);
    printf(" %4u %9.3f %9.1f\n", t->iterations, t->total_ms / 1e3, t->peak_bytes / 0x1p20);
    fflush(stdout);
}

static void write_row(json *out, const hard_conductor *c, cscd_charge_solver solver, const charge_trial *t) {
    if (!charge_row_begin(out, "hard", c->name, c->body.triangle_count, solver)) return;
    json_integer(out, "components", t->components);
    json_string(out, "status", cscd_status_string(t->status));
    json_string(out, "detail", t->detail);
    json_number(out, "capacitance", t->status == CSCD_OK ? t->capacitance : NAN);
    json_number(out, "exact", c->capacitance);
    charge_row_end(out, t);
}

static bool run_conductor(const hard_conductor *c, const charge_limits *limits, json *out, io_error *error) {
    static const cscd_charge_solver solvers[] = {CSCD_CHARGE_DENSE, CSCD_CHARGE_TREE, CSCD_CHARGE_COARSE};
    double dense = NAN;
    for (int i = 0; i < 3; i++) {
        const charge_request request = {solvers[i], 1, false};
        charge_trial t;
        if (solvers[i] == CSCD_CHARGE_DENSE && c->body.triangle_count > limits->dense_most) continue;
        if (!charge_trial_run(&c->body, &request, &t, NULL, error)) return false;
        print_row(c, charge_solver_name(solvers[i]), &t, i == 0 ? NAN : dense);
        write_row(out, c, solvers[i], &t);
        if (i == 0 && t.status == CSCD_OK) dense = t.capacitance;
    }
    return true;
}

bool charge_print_hard(const charge_limits *limits, json *out, io_error *error) {
    bool good = true;
    printf("\nhard meshes\n  %-34s %9s %10s %-7s %13s %9s %9s %4s %9s %9s\n", "mesh", "triangles",
           "components", "solver", "capacitance", "of exact", "of dense", "its", "seconds", "peak MiB");
    for (uint32_t i = 0; good && i < HARD_CONDUCTORS; i++) {
        hard_conductor c;
        good = hard_conductor_make(i, &c, error) && run_conductor(&c, limits, out, error);
        body_free(&c.body);
    }
    return good;
}
