/* Certified steps from clean positions towards the goal: Newton's method for an elastic energy and a barrier (Li et al.,
 * Incremental Potential Contact, ACM Transactions on Graphics 39, 2020). Positions are clean after every step. */
#include "runtime/untangle/untangle.h"

#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* How near surfaces may come before the barrier acts, in edge lengths. */
static const double barrier_reach = 0.1;

/* A step counts if it lowers the energy by this share of what the slope promises (Armijo). */
static const double armijo = 1e-4;

/* A step that gains less than this share of the energy is the last one. */
static const double least_gain = 2e-3;

/* Vertices that are pushed by less than this share of the greatest force stay. */
static const double least_force = 1e-4;

enum { HALVINGS = 12, RINGS_LEAST = 2 };

typedef struct descent {
    untangle_work *w;
    double spread;
    double *x;                                              /* where it is: clean */
    double *displacement, *gradient, *step, *trial, *tried; /* as long as x */
    cscd_energy_options barrier;
    double *blocks;        /* 144 numbers per pair */
    cscd_proximity *pairs; /* at x */
    size_t pair_count, pair_capacity;
    double energy;
} descent;

static array_list list_arrays(descent *d) {
    const size_t n = 3 * (size_t)d->w->mesh->vertex_count;
    return (array_list){{ARRAY(d->displacement, n), ARRAY(d->gradient, n), ARRAY(d->step, n),
                         ARRAY(d->trial, n), ARRAY(d->tried, n)}};
}

static array_list pair_arrays(descent *d, size_t count) {
    return (array_list){{ARRAY(d->blocks, 144 * count), ARRAY(d->pairs, count)}};
}

static void free_memory(descent *d) {
    context_free_all(d->w->context, list_arrays(d));
    context_free_all(d->w->context, pair_arrays(d, 0));
}

/* ---- the energy ---------------------------------------------------------------------------------------- */

static void find_displacement(const descent *d, const double *x) {
    const size_t n = 3 * (size_t)d->w->mesh->vertex_count;
    for (size_t i = 0; i < n; i++) d->displacement[i] = x[i] - d->w->goal[i];
}

/* Sums a gradient of vertices up to that of unknowns. */
static void join_gradient(const descent *d) {
    const vertex_graph *g = &d->w->graph;
    for (uint32_t v = 0; v < d->w->mesh->vertex_count; v++) {
        double *at = d->gradient + 3 * (size_t)v;
        if (g->names[v] != v)
            vec3_add_scaled(d->gradient + 3 * (size_t)g->names[v], 1.0, at,
                            d->gradient + 3 * (size_t)g->names[v]);
    }
    for (uint32_t v = 0; v < d->w->mesh->vertex_count; v++) {
        if (g->names[v] != v || g->fixed[v]) memset(d->gradient + 3 * (size_t)v, 0, sizeof(double[3]));
    }
}

static cscd_status keep_pairs(descent *d, const cscd_proximities *near) {
    if (!context_renew_all(d->w->context, pair_arrays(d, room_with_spare(near->count)), &d->pair_capacity,
                           near->count))
        return CSCD_OUT_OF_MEMORY;
    if (near->count > 0) memcpy(d->pairs, near->items, near->count * sizeof *near->items);
    d->pair_count = near->count;
    return CSCD_OK;
}

/* Finds the energy at positions, and its derivatives. */
static cscd_status evaluate_at(descent *d, const double *x, double *energy) {
    untangle_work *w = d->w;
    cscd_proximities near;
    cscd_energy_sum sum;
    cscd_status status = solver_find_near(w->detector, WORK_VIEW(w, x), d->barrier.reach,
                                          CSCD_NEAR_UNIQUE | CSCD_NEAR_BEYOND, &near);
    if (status == CSCD_OK) status = keep_pairs(d, &near);
    if (status != CSCD_OK) return status;
    find_displacement(d, x);
    elastic_gradient(w, d->spread, d->displacement, d->gradient);
    const cscd_energy_targets targets = {
        .gradient = d->gradient, .blocks = d->blocks, .project = true, .add = true};
    const cscd_proximities pairs = {d->pairs, d->pair_count};
    status = energy_evaluate(w->energy, &pairs, WORK_VIEW(w, x), &d->barrier, &targets, &sum);
    if (status != CSCD_OK) return status;
    join_gradient(d);
    *energy = elastic_value(w, d->spread, d->displacement) + sum.value;
    return CSCD_OK;
}

/* The barrier balances the greatest elastic force where surfaces are about half of its reach apart. */
static void choose_stiffness(descent *d) {
    const size_t n = d->w->mesh->vertex_count;
    double greatest = 0.0;
    find_displacement(d, d->x);
    elastic_gradient(d->w, d->spread, d->displacement, d->gradient);
    for (size_t v = 0; v < n; v++) {
        const double *g = d->gradient + 3 * v;
        greatest = max_of(greatest, vec3_dot(g, g));
    }
    d->barrier = (cscd_energy_options){.struct_size = sizeof d->barrier,
                                       .law = CSCD_ENERGY_BARRIER,
                                       .reach = barrier_reach * d->w->graph.edge_length,
                                       .by_count = true,
                                       .beyond = true};
    d->barrier.stiffness = sqrt(greatest) / (1.2 * d->barrier.reach);
}

/* ---- a step -------------------------------------------------------------------------------------------- */

static void choose_region(descent *d) {
    untangle_work *w = d->w;
    const size_t n = w->mesh->vertex_count;
    double greatest = 0.0;
    for (size_t v = 0; v < n; v++) greatest = max_of(greatest, vec3_largest(d->gradient + 3 * v));
    vertex_region_clear(&w->region);
    for (uint32_t v = 0; v < n; v++) {
        if (vec3_largest(d->gradient + 3 * (size_t)v) > least_force * greatest)
            vertex_region_add(&w->region, &w->graph, v);
    }
    for (size_t i = 0; i < d->pair_count; i++) {
        for (int k = 0; k < 4; k++) vertex_region_add(&w->region, &w->graph, d->pairs[i].vertices[k]);
    }
    const uint32_t rings = elastic_rings(w, d->spread);
    vertex_region_grow(&w->region, &w->graph, rings > RINGS_LEAST ? rings : RINGS_LEAST);
}

static bool add_pairs(descent *d) {
    untangle_work *w = d->w;
    if (!block_system_reserve(&w->system, 10 * d->pair_count)) return false;
    for (size_t i = 0; i < d->pair_count; i++) {
        const double *hessian = d->blocks + 144 * i;
        const int count = energy_vertices_of(d->pairs[i].kind);
        for (int a = 0; a < count; a++) {
            for (int b = a; b < count; b++) {
                const uint32_t row = vertex_region_row(&w->region, &w->graph, d->pairs[i].vertices[a]);
                const uint32_t column = vertex_region_row(&w->region, &w->graph, d->pairs[i].vertices[b]);
                double block[9];
                if (row == NO_ROW || column == NO_ROW) continue;
                for (int k = 0; k < 9; k++) block[k] = hessian[12 * (3 * a + k / 3) + 3 * b + k % 3];
                block_system_add_block(&w->system, row, column, block);
            }
        }
    }
    return true;
}

/* Writes the step of Newton's method, and returns its slope. */
static cscd_status find_step(descent *d, double *slope) {
    untangle_work *w = d->w;
    const vertex_region *r = &w->region;
    choose_region(d);
    if (!block_system_begin(&w->system, r->count) || !elastic_add(w, d->spread) || !add_pairs(d))
        return CSCD_OUT_OF_MEMORY;
    cscd_status status = block_system_factor(&w->system);
    if (status != CSCD_OK) return status;
    for (size_t row = 0; row < r->count; row++) {
        for (size_t k = 0; k < 3; k++)
            w->right_side[3 * row + k] = -d->gradient[3 * (size_t)r->vertices[row] + k];
    }
    block_system_solve(&w->system, w->right_side);
    *slope = 0.0;
    for (size_t row = 0; row < r->count; row++)
        *slope += vec3_dot(w->right_side + 3 * row, d->gradient + 3 * (size_t)r->vertices[row]);
    memset(d->step, 0, 3 * (size_t)w->mesh->vertex_count * sizeof *d->step);
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        const uint32_t row = vertex_region_row(r, &w->graph, v);
        if (row != NO_ROW)
            memcpy(d->step + 3 * (size_t)v, w->right_side + 3 * (size_t)row, sizeof(double[3]));
    }
    return CSCD_OK;
}

/* Goes along the step as far as is certified and lowers the energy. *gain: by how much; 0: it does not move. */
static cscd_status go_along_step(descent *d, double slope, double *gain) {
    untangle_work *w = d->w;
    const size_t n = 3 * (size_t)w->mesh->vertex_count;
    double longest = 1.0;
    *gain = 0.0;
    for (int i = 0; i < HALVINGS && work_goes_on(w); i++, longest *= 0.5) {
        cscd_free_step free;
        double energy;
        for (size_t k = 0; k < n; k++) d->trial[k] = d->x[k] + longest * d->step[k];
        work_flush(w, d->trial);
        if (!work_in_range(w, d->trial)) continue;
        cscd_status status = solver_max_step(w->detector, WORK_VIEW(w, d->x), WORK_VIEW(w, d->trial),
                                             WORK_MUTABLE(w, d->tried), &free);
        if (status == CSCD_IN_CONTACT || (status == CSCD_OK && !free.moved)) return CSCD_OK;
        if (status == CSCD_OK) status = evaluate_at(d, d->tried, &energy);
        if (status != CSCD_OK) return status;
        const double share = longest * free.fraction;
        if (energy <= d->energy + armijo * share * slope) {
            *gain = d->energy - energy;
            d->energy = energy;
            memcpy(d->x, d->tried, n * sizeof *d->x);
            return CSCD_OK;
        }
        longest = share;
    }
    double energy;
    return evaluate_at(d, d->x, &energy);
}

/* ---- all steps ----------------------------------------------------------------------------------------- */

static cscd_status take_steps(descent *d) {
    untangle_work *w = d->w;
    choose_stiffness(d);
    if (d->barrier.reach < least_length) return CSCD_OK;
    if (!(d->barrier.stiffness > 0.0 && d->barrier.stiffness < (double)INFINITY)) return CSCD_OK;
    cscd_status status = evaluate_at(d, d->x, &d->energy);
    for (uint32_t i = 0; status == CSCD_OK && i < w->options.max_steps && work_goes_on(w); i++) {
        double slope = 0.0, gain = 0.0;
        work_say(w, "descending", (double)i / w->options.max_steps);
        status = find_step(d, &slope);
        if (status == CSCD_OK && -slope < 1e-10 * fabs(d->energy)) break;
        if (status == CSCD_OK) status = go_along_step(d, slope, &gain);
        if (!(gain > 0.0)) break;
        w->found.steps++;
        if (gain < least_gain * d->energy) break;
    }
    return status;
}

cscd_status descent_run(untangle_work *w, double spread, double *x) {
    descent d = {.w = w, .spread = spread, .x = x};
    cscd_status status = CSCD_OUT_OF_MEMORY;
    if (context_allocate_all(w->context, list_arrays(&d))) status = work_settle(w, take_steps(&d));
    free_memory(&d);
    return status;
}
