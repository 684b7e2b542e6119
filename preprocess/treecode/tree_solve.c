/* Solves for the charges of a component: treecode, preconditioner, GMRES. */
#include "preprocess/treecode/tree_solve.h"

#include "preprocess/treecode/gmres.h"
#include "preprocess/treecode/near_blocks.h"
#include "src/core/timer.h"

#include <math.h>

enum { ITERATIONS_MOST = 300 };

/* Between sheets that almost touch, rounding ends the iterations before the tolerance. With so small a residual the charges are still
 * better than those that CSCD_CHARGE_COARSE asks for. */
static const double residual_most = 1e-3;

/* The equations, and what they have come to. */
typedef struct tree_equations {
    treecode t;
    near_blocks blocks;
    double tolerance;
} tree_equations;

static cscd_status multiply_charges(void *data, const double *charges, double *potentials) {
    tree_equations *e = data;
    return treecode_evaluate(&e->t, charges, potentials);
}

static void precondition_potentials(void *data, const double *potentials, double *charges) {
    const tree_equations *e = data;
    near_blocks_apply(&e->blocks, potentials, charges);
}

/* The iterations are the stage from 0.4 on; while one runs, its progress is that of the last. */
static void tell_share(void *data, double share) {
    const tree_equations *e = data;
    progress_stage(&e->t.context->progress, "charge: iteration", 0.4 + 0.6 * share, 1.0);
}

uint32_t tree_solve_worst(const double *potentials, uint32_t count) {
    uint32_t worst = 0;
    for (uint32_t k = 1; k < count; k++)
        if (fabs(potentials[k] - 1.0) > fabs(potentials[worst] - 1.0)) worst = k;
    return worst;
}

static uint32_t worst_triangle(const tree_equations *e, const charge_system *system,
                               const double *potentials) {
    const uint32_t unknown = e->t.tree.sources[tree_solve_worst(potentials, system->count)].unknown;
    const charge_point *point = system->points;
    while (point->unknown != unknown) point++;
    return point->triangle;
}

static cscd_status fail_singular(tree_equations *e, const charge_system *system, gmres_result result,
                                 const double *charges, double *potentials) {
    const cscd_status status = treecode_evaluate(&e->t, charges, potentials);
    if (status != CSCD_OK) return status;
    return context_fail(
        e->t.context, CSCD_INVALID_ARGUMENT,
        "charge: the charges of component %u cannot be told apart in its %u equations: after %u iterations the "
        "potential still differs by %.2g of what it should be, most at triangle %u; some triangles there lie "
        "(almost) on each other or on one line; move or remove them",
        system->component, system->count, result.iterations, result.residual,
        worst_triangle(e, system, potentials));
}

static cscd_status find_charges(tree_equations *e, charge_system *system) {
    cscd_context *context = e->t.context;
    const linear_equations equations = {context,          system->count,           e,
                                        multiply_charges, precondition_potentials, tell_share};
    gmres_result result;
    double *right = context_reserve(context, 2 * (size_t)system->count, sizeof *right);
    if (right == NULL) return context_out_of_memory(context);
    double *charges = right + system->count;
    for (uint32_t i = 0; i < system->count; i++) right[i] = 1.0;
    tell_share(e, 0.0);
    cscd_status status = gmres_solve(&equations, right, e->tolerance, ITERATIONS_MOST, charges, &result);
    if (status == CSCD_OK && !(result.residual <= fmax(e->tolerance, residual_most)))
        status = fail_singular(e, system, result, charges, right);
    if (status == CSCD_OK)
        for (uint32_t i = 0; i < system->count; i++)
            system->charges[e->t.tree.sources[i].unknown] = charges[i];
    context_free(context, right);
    return status;
}

/* What has been laid out already counts as well. */
static cscd_status check_limit(const tree_equations *e, const charge_system *system, size_t memory_limit) {
    const double gibibyte = 0x1p30;
    charge_system same;
    const double held = (double)charge_system_lay_out(&same, system->count, NULL),
                 sides = 2.0 * sizeof(double) * system->count; /* of the equations */
    const double bytes =
        held + sides + treecode_bytes(&e->t) + near_blocks_bytes(&e->t) + gmres_bytes(system->count);
    if (bytes <= (double)memory_limit) return CSCD_OK;
    return context_fail(
        e->t.context, CSCD_OUT_OF_MEMORY,
        "charge: a component of %u triangles takes %.4g GiB of memory, and %.4g GiB are available; "
        "simplify the mesh or use a machine with more memory",
        system->count, bytes / gibibyte, (double)memory_limit / gibibyte);
}

cscd_status tree_solve(cscd_context *context, charge_system *system, size_t memory_limit, double tolerance,
                       charge_timings *timings) {
    tree_equations e = {.tolerance = tolerance};
    double clock = timer_now_ms();
    if (system->count == 0) return CSCD_OK;
    progress_stage(&context->progress, "charge: tree", 0.0, 0.15);
    cscd_status status = treecode_create(context, system, &e.t);
    if (status != CSCD_OK) return status;
    status = check_limit(&e, system, memory_limit);
    if (status == CSCD_OK) status = treecode_fill(&e.t);
    if (status == CSCD_OK)
        status = check_limit(&e, system, memory_limit); /* the ranks of blocks are known now */
    progress_stage(&context->progress, "charge: blocks", 0.15, 0.4);
    if (status == CSCD_OK) status = near_blocks_create(&e.t, &e.blocks);
    timer_lap(&clock, &timings->assembly_ms);
    if (status == CSCD_OK) status = find_charges(&e, system);
    timer_lap(&clock, &timings->refine_ms);
    near_blocks_destroy(&e.blocks);
    treecode_destroy(&e.t);
    return status;
}
