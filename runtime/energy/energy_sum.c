/* Sums of energies over many terms: rounds of terms are evaluated by all threads, and then added in their order. */
#include "runtime/energy/energy.h"

#include "src/core/floating.h"

#include <math.h>
#include <string.h>

/* The number of terms that one task evaluates, and the shares of a thread in a round. */
enum { TERMS_PER_SHARE = ENERGY_BATCH, SHARES_PER_THREAD = 4, LEAST_ROUND = 512, LARGEST_ROUND = 16384 };

/* A place that a pattern does not have. */
#define NO_SLOT UINT32_MAX

static size_t lesser_of(size_t a, size_t b) {
    return a < b ? a : b;
}

/* A sum in progress. */
typedef struct energy_sum {
    cscd_context *context;
    const cscd_mesh *mesh;
    const energy_terms *terms;
    const cscd_energy_targets *targets;
    sum_memory *memory;
    size_t first, end;   /* of the round */
    uint32_t task_count; /* of those that add */
} energy_sum;

/* ---- memory -------------------------------------------------------------------------------------------- */

void sum_memory_free(cscd_context *context, sum_memory *memory) {
    context_free(context, memory->gradients);
    context_free(context, memory->hessians);
    context_free(context, memory->values);
    context_free(context, memory->gaps);
    context_free(context, memory->slots);
    *memory = (sum_memory){NULL};
}

static size_t terms_of_round(cscd_context *context) {
    size_t terms = (size_t)parallel_thread_count(context->threads) * SHARES_PER_THREAD * TERMS_PER_SHARE;
    return terms < LEAST_ROUND ? LEAST_ROUND : terms > LARGEST_ROUND ? LARGEST_ROUND : terms;
}

/* Makes the memory of a round, once, and that of the slots, which grows. */
static bool reserve_memory(const energy_sum *s) {
    sum_memory *m = s->memory;
    if (m->round == 0) m->round = terms_of_round(s->context);
    if (m->values == NULL) m->values = context_reserve(s->context, m->round, sizeof *m->values);
    if (m->gaps == NULL) m->gaps = context_reserve(s->context, m->round, sizeof *m->gaps);
    bool all = m->values != NULL && m->gaps != NULL;
    if (s->targets->gradient != NULL && m->gradients == NULL) {
        m->gradients = context_reserve(s->context, m->round, sizeof *m->gradients);
        all = all && m->gradients != NULL;
    }
    if (s->targets->matrix == NULL) return all;
    if (s->targets->blocks == NULL && m->hessians == NULL) {
        m->hessians = context_reserve(s->context, m->round, sizeof *m->hessians);
        all = all && m->hessians != NULL;
    }
    if (m->slot_capacity < s->terms->count || m->slots == NULL) {
        size_t room = room_with_spare(s->terms->count);
        context_free(s->context, m->slots);
        m->slots = context_reserve(s->context, room, sizeof *m->slots);
        m->slot_capacity = m->slots != NULL ? room : 0;
        all = all && m->slots != NULL;
    }
    return all;
}

/* ---- places in the pattern ------------------------------------------------------------------------------ */

static uint32_t find_slot(const cscd_energy_pattern *pattern, uint32_t row, uint32_t column) {
    const uint32_t *columns = pattern->columns + pattern->rows[row];
    size_t low = 0, count = pattern->rows[row + 1] - pattern->rows[row];
    while (count > 0) {
        size_t half = count / 2;
        bool above = columns[low + half] < column;
        low = above ? low + half + 1 : low;
        count = above ? count - half - 1 : half;
    }
    bool found = low < pattern->rows[row + 1] - pattern->rows[row] && columns[low] == column;
    return found ? (uint32_t)low : NO_SLOT;
}

static void find_slots(void *data, uint32_t share) {
    const energy_sum *s = data;
    size_t end = lesser_of((size_t)(share + 1) * TERMS_PER_SHARE, s->terms->count);
    for (size_t i = (size_t)share * TERMS_PER_SHARE; i < end; i++) {
        const uint32_t *v = energy_term_vertices(s->terms, i);
        int size = energy_term_size(s->terms, i);
        for (int r = 0; r < size; r++) {
            for (int c = 0; c < size; c++)
                s->memory->slots[i][4 * r + c] = find_slot(s->targets->pattern, v[r], v[c]);
        }
    }
}

static cscd_status check_slots(const energy_sum *s) {
    for (size_t i = 0; i < s->terms->count; i++) {
        const uint32_t *v = energy_term_vertices(s->terms, i);
        int size = energy_term_size(s->terms, i);
        for (int j = 0; j < size * size; j++) {
            if (s->memory->slots[i][4 * (j / size) + j % size] != NO_SLOT) continue;
            return context_fail(s->context, CSCD_INVALID_ARGUMENT,
                                "the pattern has no block for the vertices %u and %u of item %zu; "
                                "cscd_energy_make_pattern makes one that has",
                                v[j / size], v[j % size], i);
        }
    }
    return CSCD_OK;
}

/* ---- a round ------------------------------------------------------------------------------------------- */

static double (*hessian_of_term(const energy_sum *s, size_t i))[12] {
    if (s->targets->blocks != NULL) return (double(*)[12])(void *)(s->targets->blocks + 144 * i);
    return s->targets->matrix != NULL ? s->memory->hessians[i - s->first] : NULL;
}

static void evaluate_share(void *data, uint32_t share) {
    const energy_sum *s = data;
    size_t begin = s->first + (size_t)share * TERMS_PER_SHARE;
    size_t end = lesser_of(begin + TERMS_PER_SHARE, s->end);
    bool hessians = s->targets->blocks != NULL || s->targets->matrix != NULL;
    if (!hessians && s->terms->evaluate_batch != NULL) {
        const size_t place = begin - s->first;
        const energy_outputs out = {s->memory->values + place, s->memory->gaps + place,
                                    s->targets->gradient != NULL ? s->memory->gradients + place : NULL};
        s->terms->evaluate_batch(s->terms->of, begin, end - begin, &out);
        return;
    }
    for (size_t i = begin; i < end; i++) {
        energy_term term = {.project = s->targets->project, .hessian = hessian_of_term(s, i)};
        if (s->targets->gradient != NULL) term.gradient = s->memory->gradients[i - s->first];
        s->terms->evaluate(s->terms->of, i, &term);
        s->memory->values[i - s->first] = term.value;
        s->memory->gaps[i - s->first] = term.gap;
    }
}

/* Writes nine numbers to their places in a row of blocks. */
static void add_block(const energy_sum *s, uint32_t row, uint32_t slot, double (*hessian)[12], int r, int c) {
    const cscd_energy_pattern *pattern = s->targets->pattern;
    size_t first = pattern->rows[row], length = pattern->rows[row + 1] - first;
    size_t stride = s->targets->scalar_rows ? 3 * length : 3;
    double *out = s->targets->matrix + 9 * first + (s->targets->scalar_rows ? 3 : 9) * (size_t)slot;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) out[(size_t)i * stride + (size_t)j] += hessian[3 * r + i][3 * c + j];
    }
}

static void add_gradient(const energy_sum *s, size_t i, int r, uint32_t vertex) {
    const double *from = s->memory->gradients[i - s->first][r];
    double *to = s->targets->gradient + 3 * (size_t)vertex;
    for (int k = 0; k < 3; k++) to[k] += from[k];
}

static void add_hessian(const energy_sum *s, size_t i, int r, const uint32_t *v, int size) {
    double(*hessian)[12] = hessian_of_term(s, i);
    for (int c = 0; c < size; c++) add_block(s, v[r], s->memory->slots[i][4 * r + c], hessian, r, c);
}

/* Eight neighbours in memory have one task, which adds to them in the order of terms. Vertices that repeat an earlier one have a gradient
 * of 0: to add it takes less time than to foresee how many there are. */
static void add_share(void *data, uint32_t task) {
    const energy_sum *s = data;
    const bool alone = s->task_count == 1, gradient = s->targets->gradient != NULL;
    for (size_t i = s->first; i < s->end; i++) {
        const uint32_t *v = energy_term_vertices(s->terms, i);
        const int size = s->targets->matrix != NULL ? energy_term_size(s->terms, i) : 0;
        for (int r = 0; r < 4; r++) {
            if (!alone && v[r] / 8 % s->task_count != task) continue;
            if (gradient) add_gradient(s, i, r, v[r]);
            if (r < size) add_hessian(s, i, r, v, size);
        }
    }
}

/* Values are added one by one, because rounds depend on the number of threads. */
static void add_values(const energy_sum *s, cscd_energy_sum *out) {
    for (size_t i = s->first; i < s->end; i++) {
        double value = s->memory->values[i - s->first];
        out->least = min_of(out->least, s->memory->gaps[i - s->first]);
        out->active += value != 0.0;
        out->value += value;
        if (value != INFINITY) continue;
        if (out->infinite == 0) out->first = i;
        out->infinite++;
    }
}

static void sum_round(energy_sum *s, cscd_energy_sum *out) {
    uint32_t shares = (uint32_t)((s->end - s->first + TERMS_PER_SHARE - 1) / TERMS_PER_SHARE);
    parallel_run(s->context->threads, shares, evaluate_share, s);
    add_values(s, out);
    if (s->targets->gradient != NULL || s->targets->matrix != NULL)
        parallel_run(s->context->threads, s->task_count, add_share, s);
}

/* ---- sums ---------------------------------------------------------------------------------------------- */

static void clear_targets(const energy_sum *s) {
    const cscd_energy_targets *t = s->targets;
    if (t->add) return;
    if (t->gradient != NULL) memset(t->gradient, 0, (size_t)s->mesh->vertex_count * 3 * sizeof *t->gradient);
    if (t->matrix != NULL) memset(t->matrix, 0, t->pattern->block_count * 9 * sizeof *t->matrix);
}

cscd_status energy_targets_check(cscd_context *context, const cscd_mesh *mesh,
                                 const cscd_energy_targets *targets) {
    if (targets->matrix == NULL) return CSCD_OK;
    if (targets->pattern == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "targets have a matrix, but pattern is NULL");
    return energy_pattern_check(context, mesh, targets->pattern);
}

cscd_status energy_sum_terms(cscd_context *context, const cscd_mesh *mesh, const energy_terms *terms,
                             const cscd_energy_targets *targets, sum_memory *memory, cscd_energy_sum *out) {
    static const cscd_energy_targets none = {NULL};
    energy_sum s = {context, mesh, terms, targets != NULL ? targets : &none, memory, 0, 0, 1};
    cscd_energy_sum found = {.least = INFINITY, .first = SIZE_MAX};
    if (!reserve_memory(&s)) return context_out_of_memory(context);
    if (s.targets->matrix != NULL) {
        uint32_t shares = (uint32_t)((terms->count + TERMS_PER_SHARE - 1) / TERMS_PER_SHARE);
        parallel_run(context->threads, shares, find_slots, &s);
        cscd_status status = context_loop_status(context);
        if (status == CSCD_OK) status = check_slots(&s);
        if (status != CSCD_OK) return status;
    }
    s.task_count = parallel_thread_count(context->threads);
    clear_targets(&s);
    for (s.first = 0; s.first < terms->count; s.first = s.end) {
        s.end = lesser_of(s.first + memory->round, terms->count);
        sum_round(&s, &found);
    }
    cscd_status status = context_loop_status(context);
    if (status == CSCD_OK) *out = found;
    return status;
}
