/* A solution for charges in a process of its own, so that its peak of memory is known and memory that others left
 * does not matter; and the tables of benchmarks/charge.c, which are made of such trials. */
#include "benchmarks/lib/charge_trial.h"

#include "preprocess/preprocess.h"
#include "src/core/context.h"
#include "src/core/timer.h"

#include <errno.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* Shared by both processes. */
typedef struct shared_trial {
    bool done;
    charge_trial trial;
    double density[];
} shared_trial;

/* The objects that the process works with. */
typedef struct trial_work {
    const body *body;
    const charge_request *request;
    cscd_context *context;
    cscd_mesh *mesh;
    double iterated; /* how far the call was when an iteration was told of last */
    shared_trial *out;
} trial_work;

/* Each iteration moves the fraction, and nothing else does while they run. */
static bool count_iterations(void *user, const char *stage, double fraction) {
    trial_work *w = user;
    if (strcmp(stage, "charge: iteration") == 0 && fraction > w->iterated) {
        w->iterated = fraction;
        w->out->trial.iterations++;
    }
    return true;
}

/* The first call of each component's iterations is no iteration. With several threads the one that asks may have no part in some. */
static void correct_iterations(const trial_work *w) {
    charge_trial *t = &w->out->trial;
    if (w->request->threads > 1) t->iterations = 0;
    t->iterations -= t->iterations < t->components ? t->iterations : t->components;
}

static cscd_status find_charges(trial_work *w) {
    const body *b = w->body;
    charge_trial *t = &w->out->trial;
    const charge_options options = {w->request->solver, 0};
    charge_report report;
    double *density = body_allocate(b->triangle_count, sizeof *density),
           *capacitance = body_allocate(t->components, sizeof *capacitance);
    progress_begin_call(&w->context->progress);
    progress_begin(&w->context->progress);
    const cscd_status status = charge_solve(w->mesh, b->positions, &options, density, capacitance, &report);
    if (status == CSCD_OK) {
        t->assembly_ms = report.timings.assembly_ms;
        t->solve_ms = report.timings.factor_ms + report.timings.refine_ms;
        t->total_ms = report.timings.total_ms;
        for (uint32_t c = 0; c < t->components; c++) t->capacitance += capacitance[c];
        memcpy(w->out->density, density, b->triangle_count * sizeof *density);
    }
    free(density);
    free(capacitance);
    return status;
}

static cscd_status make_plan(trial_work *w) {
    const body *b = w->body;
    charge_trial *t = &w->out->trial;
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.method = CSCD_METHOD_CHARGE;
    options.charge_solver = w->request->solver;
    const cscd_status status =
        cscd_plan_create(w->context, w->mesh, CSCD_DOUBLES(b->positions, b->vertex_count), &options, &plan);
    if (status != CSCD_OK) return status;
    const cscd_preprocess_timings timings = cscd_plan_timings(plan);
    t->assembly_ms = timings.assembly_ms;
    t->solve_ms = timings.solve_ms;
    t->regions_ms = timings.regions_ms;
    t->total_ms = timings.total_ms;
    t->regions = cscd_plan_region_count(plan);
    for (uint32_t c = 0; c < t->components; c++) t->capacitance += cscd_plan_capacitance(plan, c);
    for (uint32_t i = 0; i < b->triangle_count; i++) w->out->density[i] = cscd_plan_triangle_charge(plan, i);
    cscd_plan_destroy(plan);
    return CSCD_OK;
}

static cscd_status make_mesh(trial_work *w) {
    const cscd_object_desc desc =
        cscd_object_of_triangles(w->body->vertex_count, w->body->triangle_count, w->body->triangles);
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = w->request->threads;
    options.progress = (cscd_progress){count_iterations, w};
    cscd_status status = cscd_context_create(&options, &w->context);
    if (status != CSCD_OK) return status;
    w->context->progress.interval_ms = 0.0;
    status = cscd_mesh_create(w->context, &desc, 1, &w->mesh);
    if (status == CSCD_OK) w->out->trial.components = cscd_mesh_component_count(w->mesh);
    return status;
}

/* The process that solves. */
static void run_child(trial_work *w) {
    charge_trial *t = &w->out->trial;
    t->status = make_mesh(w);
    const double start = timer_now_ms();
    if (t->status == CSCD_OK) t->status = w->request->regions ? make_plan(w) : find_charges(w);
    if (t->status != CSCD_OK) {
        t->total_ms = timer_now_ms() - start;
        snprintf(t->detail, sizeof t->detail, "%s",
                 w->context != NULL ? cscd_context_detail(w->context) : "there is no context");
    }
    correct_iterations(w);
    w->out->done = true;
    _exit(EXIT_SUCCESS);
}

/* Waits for the process, which has ended well if it has said so. */
static bool await_child(pid_t child, shared_trial *shared, io_error *error) {
    struct rusage usage;
    int status = 0;
    while (wait4(child, &status, 0, &usage) < 0)
        if (errno != EINTR) return io_fail(error, "%s", strerror(errno));
    if (WIFSIGNALED(status))
        return io_fail(error, "the process that solved ended by signal %d", WTERMSIG(status));
    shared->trial.peak_bytes = (double)usage.ru_maxrss * 1024.0;
    return shared->done || io_fail(error, "the process that solved ended early");
}

bool charge_trial_run(const body *b, const charge_request *request, charge_trial *out, double *density,
                      io_error *error) {
    const size_t size = sizeof(shared_trial) + b->triangle_count * sizeof(double);
    shared_trial *shared = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) return io_fail(error, "%s", strerror(errno));
    trial_work w = {.body = b, .request = request, .iterated = -1.0, .out = shared};
    fflush(NULL);
    malloc_trim(0); /* the process begins with what this one holds */
    const pid_t child = fork();
    if (child == 0) run_child(&w);
    const bool good = child > 0 ? await_child(child, shared, error) : io_fail(error, "%s", strerror(errno));
    if (good) {
        *out = shared->trial;
        if (density != NULL) memcpy(density, shared->density, b->triangle_count * sizeof *density);
    }
    munmap(shared, size);
    return good;
}

const char *charge_solver_name(cscd_charge_solver solver) {
    return solver == CSCD_CHARGE_DENSE ? "dense" : solver == CSCD_CHARGE_COARSE ? "coarse" : "tree";
}

bool charge_row_begin(json *out, const char *table, const char *name, uint32_t triangles,
                      cscd_charge_solver solver) {
    if (out->file == NULL) return false;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "table", table);
    json_string(out, "body", name);
    json_integer(out, "triangles", triangles);
    json_string(out, "solver", charge_solver_name(solver));
    return true;
}

void charge_row_end(json *out, const charge_trial *t) {
    json_integer(out, "iterations", t->iterations);
    json_number(out, "total_ms", t->total_ms);
    json_number(out, "peak_bytes", t->peak_bytes);
    json_end_object(out);
}
