/* Solves for the charges of a component: treecode, preconditioner, GMRES. */
#include "preprocess/treecode/treecode.h"

#include "preprocess/treecode/source_tree.h"
#include "src/core/timer.h"

#include <math.h>
#include <string.h>

/* ---- GMRES --------------------------------------------------------------------------------------------- */

/* Restarted GMRES solves linear equations whose matrix is only a function, with a preconditioner on the right (Saad, Schultz 1986):
 * an orthonormal basis of the Krylov space, and Givens rotations of the small problem in it. */
typedef struct linear_equations {
    cscd_context *context;
    uint32_t count;
    void *data;
    cscd_status (*multiply)(void *data, const double *in, double *out);
    void (*precondition)(void *data, const double *in, double *out); /* about the inverse of multiply */
    void (*tell)(void *data, double share); /* how far the solution has come, after each iteration */
} linear_equations;

typedef struct gmres_result {
    uint32_t iterations;
    double residual; /* over that of 0, in the Euclidean norm */
} gmres_result;

/* Sums are taken in blocks, whose order does not depend on who adds them. */
enum { BASIS_MOST = 30, NUMBERS_PER_BLOCK = 4096 };

typedef struct gmres {
    const linear_equations *equations;
    uint32_t block_count;
    double *basis[BASIS_MOST + 1];
    double *preconditioned, *block_sums;
    double columns[BASIS_MOST][BASIS_MOST + 1]; /* of the Hessenberg matrix, rotated */
    double cosines[BASIS_MOST], sines[BASIS_MOST];
    double rotated[BASIS_MOST + 1]; /* right-hand side of the small problem */
} gmres;

/* ---- vectors ------------------------------------------------------------------------------------------- */

/* y += factor x, or sums[block] = x . y where there are sums. */
typedef struct vector_task {
    const double *x;
    double *y, *sums, factor;
    uint32_t count;
} vector_task;

static void run_block(void *data, uint32_t block) {
    const vector_task *t = data;
    const uint32_t begin = block * NUMBERS_PER_BLOCK;
    const uint32_t end = t->count - begin < NUMBERS_PER_BLOCK ? t->count : begin + NUMBERS_PER_BLOCK;
    double sums[4] = {0.0, 0.0, 0.0, 0.0};
    if (t->sums == NULL) {
        for (uint32_t i = begin; i < end; i++) t->y[i] += t->factor * t->x[i];
        return;
    }
    for (uint32_t i = begin; i < end; i++) sums[i % 4] += t->x[i] * t->y[i];
    t->sums[block] = (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

static double dot_product(const gmres *g, const double *x, double *y) {
    vector_task task = {x, y, g->block_sums, 0.0, g->equations->count};
    double sum = 0.0;
    parallel_run(g->equations->context->threads, g->block_count, run_block, &task);
    for (uint32_t i = 0; i < g->block_count; i++) sum += g->block_sums[i];
    return sum;
}

static void add_multiple(const gmres *g, double factor, const double *x, double *y) {
    vector_task task = {x, y, NULL, factor, g->equations->count};
    parallel_run(g->equations->context->threads, g->block_count, run_block, &task);
}

static void scale_vector(const gmres *g, double factor, double *x) {
    for (uint32_t i = 0; i < g->equations->count; i++) x[i] *= factor;
}

/* ---- a cycle ------------------------------------------------------------------------------------------- */

static void rotate_pair(double cosine, double sine, double *a, double *b) {
    const double held = cosine * *a + sine * *b;
    *b = cosine * *b - sine * *a;
    *a = held;
}

/* Multiplies the newest vector of the basis, and makes the product the next one, orthogonal to all. */
static cscd_status extend_basis(gmres *g, uint32_t k) {
    const linear_equations *e = g->equations;
    double *column = g->columns[k], *next = g->basis[k + 1];
    e->precondition(e->data, g->basis[k], g->preconditioned);
    const cscd_status status = e->multiply(e->data, g->preconditioned, next);
    if (status != CSCD_OK) return status;
    for (uint32_t i = 0; i <= k; i++) {
        column[i] = dot_product(g, g->basis[i], next);
        add_multiple(g, -column[i], g->basis[i], next);
    }
    column[k + 1] = sqrt(dot_product(g, next, next));
    if (column[k + 1] > 0.0) scale_vector(g, 1.0 / column[k + 1], next);
    return CSCD_OK;
}

/* Rotates the new column, and returns the norm of the residual that is left. */
static double rotate_column(gmres *g, uint32_t k) {
    double *column = g->columns[k];
    for (uint32_t i = 0; i < k; i++) rotate_pair(g->cosines[i], g->sines[i], &column[i], &column[i + 1]);
    /* hypot ends in other bits elsewhere, and so would plans. */
    const double length = sqrt(column[k] * column[k] + column[k + 1] * column[k + 1]);
    g->cosines[k] = length > 0.0 ? column[k] / length : 1.0;
    g->sines[k] = length > 0.0 ? column[k + 1] / length : 0.0;
    rotate_pair(g->cosines[k], g->sines[k], &column[k], &column[k + 1]);
    g->rotated[k + 1] = 0.0;
    rotate_pair(g->cosines[k], g->sines[k], &g->rotated[k], &g->rotated[k + 1]);
    return fabs(g->rotated[k + 1]);
}

/* Adds the best combination of the first `size` vectors, preconditioned. basis[size] is lost. */
static void add_combination(gmres *g, uint32_t size, double *solution) {
    const linear_equations *e = g->equations;
    double weights[BASIS_MOST], *sum = g->basis[size];
    memset(sum, 0, e->count * sizeof *sum);
    for (uint32_t k = size; k-- > 0;) {
        double left = g->rotated[k];
        for (uint32_t j = k + 1; j < size; j++) left -= g->columns[j][k] * weights[j];
        weights[k] = g->columns[k][k] != 0.0 ? left / g->columns[k][k] : 0.0;
        add_multiple(g, weights[k], g->basis[k], sum);
    }
    e->precondition(e->data, sum, g->preconditioned);
    add_multiple(g, 1.0, g->preconditioned, solution);
}

/* basis[0] = right - multiply(solution), not yet of length 1; returns its length. */
static cscd_status find_residual(gmres *g, const double *right, const double *solution, double *length) {
    const linear_equations *e = g->equations;
    const cscd_status status = e->multiply(e->data, solution, g->basis[0]);
    if (status != CSCD_OK) return status;
    for (uint32_t i = 0; i < e->count; i++) g->basis[0][i] = right[i] - g->basis[0][i];
    *length = sqrt(dot_product(g, g->basis[0], g->basis[0]));
    return CSCD_OK;
}

/* Every iteration makes the residual smaller by about the same factor. */
static void tell_progress(const gmres *g, double left, double enough, double whole) {
    const linear_equations *e = g->equations;
    e->tell(e->data, left > enough ? log(left / whole) / log(enough / whole) : 1.0);
}

/* Fills the basis, as long as the residual is above `enough`. */
static cscd_status run_cycle(gmres *g, double whole, double length, double enough, uint32_t iterations_most,
                             double *solution, uint32_t *iterations) {
    cscd_status status = CSCD_OK;
    uint32_t size = 0;
    scale_vector(g, 1.0 / length, g->basis[0]);
    g->rotated[0] = length;
    for (double left = length; size < BASIS_MOST && left > enough && *iterations < iterations_most;
         size++, ++*iterations) {
        status = extend_basis(g, size);
        if (status != CSCD_OK) return status;
        left = rotate_column(g, size);
        tell_progress(g, left, enough, whole);
    }
    add_combination(g, size, solution);
    return CSCD_OK;
}

static cscd_status solve_equations(gmres *g, const double *right, double tolerance, uint32_t iterations_most,
                                   double *solution, gmres_result *result) {
    const uint32_t count = g->equations->count;
    memcpy(g->basis[0], right, count * sizeof *right);
    memset(solution, 0, count * sizeof *solution);
    const double whole = sqrt(dot_product(g, g->basis[0], g->basis[0]));
    double length = whole, before = INFINITY;
    cscd_status status = CSCD_OK;
    *result = (gmres_result){0, whole > 0.0 ? 1.0 : 0.0};
    /* A cycle that wins less than a tenth will not come to an end. */
    while (status == CSCD_OK && length > tolerance * whole && length < 0.9 * before &&
           result->iterations < iterations_most) {
        before = length;
        status =
            run_cycle(g, whole, length, tolerance * whole, iterations_most, solution, &result->iterations);
        if (status == CSCD_OK) status = find_residual(g, right, solution, &length);
        result->residual = length / whole;
    }
    return status;
}

static array_list list_vectors(gmres *g) {
    array_list list = {{ARRAY(g->preconditioned, g->equations->count), ARRAY(g->block_sums, g->block_count)}};
    return list;
}

/* Returns the bytes that this number of equations takes in addition to those of the caller. */
static double gmres_bytes(uint32_t count) {
    return (BASIS_MOST + 2) * sizeof(double) * (double)count; /* the basis, and what is preconditioned */
}

/* Begins at 0, and ends when the residual is at most the tolerance, or after iterations_most: the result says which. The same
 * bits for any number of threads. */
static cscd_status gmres_solve(const linear_equations *equations, const double *right, double tolerance,
                               uint32_t iterations_most, double *solution, gmres_result *result) {
    cscd_context *context = equations->context;
    const uint32_t blocks =
        equations->count / NUMBERS_PER_BLOCK + (equations->count % NUMBERS_PER_BLOCK != 0);
    gmres g = {.equations = equations, .block_count = blocks};
    double *basis = context_reserve(context, (size_t)(BASIS_MOST + 1) * equations->count, sizeof *basis);
    cscd_status status = CSCD_OUT_OF_MEMORY;
    if (basis != NULL && context_reserve_all(context, list_vectors(&g))) {
        for (size_t i = 0; i <= BASIS_MOST; i++) g.basis[i] = basis + i * equations->count;
        status = solve_equations(&g, right, tolerance, iterations_most, solution, result);
    } else {
        context_out_of_memory(context);
    }
    context_free_all(context, list_vectors(&g));
    context_free(context, basis);
    return status;
}

/* ---- the charges --------------------------------------------------------------------------------------- */

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

/* The memory that has been laid out already counts as well. */
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
