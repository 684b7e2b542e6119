/* Solves for the charges of a component: treecode, preconditioner, GMRES. */
#include "preprocess/treecode/tree_solve.h"

#include "preprocess/treecode/gmres.h"
#include "preprocess/treecode/near_blocks.h"
#include "src/core/timer.h"

static const double TOLERANCE = 1e-5;

enum { ITERATIONS_MOST = 300 };

/* The equations, and what they have come to. */
typedef struct tree_equations {
    treecode t;
    near_blocks blocks;
    uint32_t multiplied;
} tree_equations;

static cscd_status multiply_charges(void *data, const double *charges, double *potentials) {
    tree_equations *e = data;
    const double usual = 14.0; /* iterations; from there on the bar stands still */
    progress_go_on(&e->t.context->progress, e->multiplied < usual ? e->multiplied / usual : 1.0);
    e->multiplied++;
    return treecode_evaluate(&e->t, charges, potentials);
}

static void precondition_potentials(void *data, const double *potentials, double *charges) {
    const tree_equations *e = data;
    near_blocks_apply(&e->blocks, potentials, charges);
}

static cscd_status fail_singular(const tree_equations *e, const charge_system *system, gmres_result result) {
    return context_fail(e->t.context, CSCD_INVALID_ARGUMENT,
                        "charge: the charges of component %u cannot be told apart in its %u equations: after %u iterations the "
                        "potential still differs by %.2g of what it should be; some triangles there lie (almost) on each other or "
                        "on one line; move or remove them",
                        system->component, system->count, result.iterations, result.residual);
}

static cscd_status find_charges(tree_equations *e, charge_system *system) {
    cscd_context *context = e->t.context;
    const linear_equations equations = {context, system->count, e, multiply_charges, precondition_potentials};
    gmres_result result;
    double *right = context_reserve(context, 2 * (size_t)system->count, sizeof *right);
    if (right == NULL) return context_out_of_memory(context);
    double *charges = right + system->count;
    for (uint32_t i = 0; i < system->count; i++) right[i] = 1.0;
    progress_stage(&context->progress, "charge: iteration", 0.2, 1.0);
    cscd_status status = gmres_solve(&equations, right, TOLERANCE, ITERATIONS_MOST, charges, &result);
    if (status == CSCD_OK && !(result.residual <= TOLERANCE)) status = fail_singular(e, system, result);
    if (status == CSCD_OK)
        for (uint32_t i = 0; i < system->count; i++) system->charges[e->t.tree.sources[i].unknown] = charges[i];
    context_free(context, right);
    return status;
}

cscd_status tree_solve(cscd_context *context, charge_system *system, size_t memory_limit, charge_timings *timings) {
    tree_equations e = {.multiplied = 0};
    double clock = timer_now_ms();
    if (system->count == 0) return CSCD_OK;
    progress_stage(&context->progress, "charge: tree", 0.0, 0.1);
    cscd_status status = treecode_create(context, system, memory_limit, &e.t);
    if (status != CSCD_OK) return status;
    progress_stage(&context->progress, "charge: blocks", 0.1, 0.2);
    status = near_blocks_create(&e.t, &e.blocks);
    timer_lap(&clock, &timings->assembly_ms);
    if (status == CSCD_OK) status = find_charges(&e, system);
    timer_lap(&clock, &timings->refine_ms);
    near_blocks_destroy(&e.blocks);
    treecode_destroy(&e.t);
    return status;
}
