/* The cost of plans by charge: milliseconds of each stage and the greatest memory, from small meshes to large
 * ones. */
#include "benchmarks/lib/charge_trial.h"
#include "models/shapes/catalogue.h"

enum { THREADS_MOST = 2 };

/* The task of a solver for this number of triangles, charge alone. */
typedef struct time_target {
    cscd_charge_solver solver;
    uint32_t triangles;
    double seconds, gibibytes; /* gibibytes 0: nothing */
} time_target;

static const time_target targets[] = {{CSCD_CHARGE_TREE, 100000, 15.0, 0.0},
                                      {CSCD_CHARGE_TREE, 1000000, 180.0, 8.0},
                                      {CSCD_CHARGE_COARSE, 100000, 3.0, 0.0},
                                      {CSCD_CHARGE_COARSE, 1000000, 20.0, 0.0}};

static double charge_ms(const charge_trial *t) {
    return t->total_ms - t->regions_ms;
}

static const time_target *target_of(cscd_charge_solver solver, uint32_t triangles) {
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++)
        if (targets[i].solver == solver && targets[i].triangles == triangles) return &targets[i];
    return NULL;
}

static void print_target(const charge_trial *t, const time_target *target) {
    if (target == NULL) {
        putchar('\n');
        return;
    }
    const bool met = charge_ms(t) <= target->seconds * 1e3 &&
                     (target->gibibytes == 0.0 || t->peak_bytes <= target->gibibytes * 0x1p30);
    printf("  %g s", target->seconds);
    if (target->gibibytes > 0.0) printf(", %g GiB", target->gibibytes);
    printf(": %s\n", met ? "met" : "missed");
}

static void print_row(const charge_request *request, uint32_t triangles, const charge_trial *t) {
    printf("  %9u %-7s %7u %10.0f %10.0f %10.0f %10.0f %10.0f %9.1f %8.0f %4u %7u", triangles,
           charge_solver_name(request->solver), request->threads, t->assembly_ms, t->solve_ms, charge_ms(t),
           t->regions_ms, t->total_ms, t->peak_bytes / 0x1p20, t->peak_bytes / triangles, t->iterations,
           t->regions);
    print_target(t, target_of(request->solver, triangles));
    fflush(stdout);
}

static void write_row(json *out, const charge_request *request, uint32_t triangles, const charge_trial *t) {
    if (!charge_row_begin(out, "times", body_kind_name(BODY_FIGURE), triangles, request->solver)) return;
    json_integer(out, "threads", request->threads);
    json_number(out, "assembly_ms", t->assembly_ms);
    json_number(out, "solve_ms", t->solve_ms);
    json_number(out, "charge_ms", charge_ms(t));
    json_number(out, "regions_ms", t->regions_ms);
    json_integer(out, "regions", t->regions);
    charge_row_end(out, t);
}

static bool run_plan(const body *b, const charge_request *request, json *out, io_error *error) {
    charge_trial t;
    if (!charge_trial_run(b, request, &t, NULL, error)) return false;
    if (t.status != CSCD_OK) return io_fail(error, "%s", t.detail);
    print_row(request, b->triangle_count, &t);
    write_row(out, request, b->triangle_count, &t);
    return true;
}

static bool run_size(uint32_t triangles, const charge_limits *limits, json *out, io_error *error) {
    static const cscd_charge_solver solvers[] = {CSCD_CHARGE_DENSE, CSCD_CHARGE_TREE, CSCD_CHARGE_COARSE};
    body b;
    if (!body_make(BODY_FIGURE, triangles, &b, error)) return false;
    bool good = true;
    for (int i = 0; good && i < 3; i++) {
        if (solvers[i] == CSCD_CHARGE_DENSE && triangles > limits->dense_most) continue;
        for (uint32_t threads = 1; good && threads <= THREADS_MOST; threads++) {
            const charge_request request = {solvers[i], threads, true};
            good = run_plan(&b, &request, out, error);
        }
    }
    body_free(&b);
    return good;
}

bool charge_print_times(const charge_limits *limits, json *out, io_error *error) {
    static const uint32_t sizes[] = {2000, 5000, 20000, 100000, 1000000};
    bool good = true;
    printf("\ntimes: plans of the figure, in ms; what is asked is of the charge alone\n"
           "  %9s %-7s %7s %10s %10s %10s %10s %10s %9s %8s %4s %7s\n",
           "triangles", "solver", "threads", "assembly", "solve", "charge", "regions", "total", "peak MiB",
           "bytes/t", "its", "regions");
    for (size_t i = 0; good && i < sizeof sizes / sizeof *sizes; i++)
        if (sizes[i] <= limits->most) good = run_size(sizes[i], limits, out, error);
    return good;
}
