/* The linear system of a Newton step, and its solution by conjugate gradients. */
#include "models/ipc/newton_system.h"
#include "models/common/vec3.h"

#include <stdlib.h>
#include <string.h>

ipc_system ipc_system_make(uint32_t vertex_count, const double *inertia, const ipc_springs *springs) {
    ipc_system s = {.vertex_count = vertex_count, .inertia = inertia, .springs = *springs};
    s.hessians = body_allocate(springs->count, sizeof *s.hessians);
    s.inverses = body_allocate(vertex_count, sizeof *s.inverses);
    s.residual = body_allocate(vertex_count, 3 * sizeof *s.residual);
    s.preconditioned = body_allocate(vertex_count, 3 * sizeof *s.preconditioned);
    s.search = body_allocate(vertex_count, 3 * sizeof *s.search);
    s.product = body_allocate(vertex_count, 3 * sizeof *s.product);
    return s;
}

void ipc_system_free(ipc_system *s) {
    free(s->hessians);
    free(s->inverses);
    free(s->residual);
    free(s->preconditioned);
    free(s->search);
    free(s->product);
    *s = (ipc_system){0};
}

static void add_outer(ipc_block *sum, double factor, const double n[3]) {
    sum->m[0] += factor * n[0] * n[0];
    sum->m[1] += factor * n[0] * n[1];
    sum->m[2] += factor * n[0] * n[2];
    sum->m[3] += factor * n[1] * n[1];
    sum->m[4] += factor * n[1] * n[2];
    sum->m[5] += factor * n[2] * n[2];
}

static void add_spring(ipc_block *sum, const ipc_spring_hessian *h) {
    add_outer(sum, h->along, h->n);
    sum->m[0] += h->aside;
    sum->m[3] += h->aside;
    sum->m[5] += h->aside;
}

/* Inverts a positive definite block by cofactors. */
static void invert_block(ipc_block *block) {
    const double *m = block->m;
    double xx = m[3] * m[5] - m[4] * m[4], xy = m[2] * m[4] - m[1] * m[5], xz = m[1] * m[4] - m[2] * m[3];
    double determinant = m[0] * xx + m[1] * xy + m[2] * xz;
    *block = (ipc_block){
        {xx / determinant, xy / determinant, xz / determinant, (m[0] * m[5] - m[2] * m[2]) / determinant,
         (m[1] * m[2] - m[0] * m[4]) / determinant, (m[0] * m[3] - m[1] * m[1]) / determinant}};
}

/* Adds the block that the contacts have on the diagonal. */
static void add_contact_block(ipc_block *sum, const ipc_system *s, uint32_t v) {
    static const int places[6] = {0, 1, 2, 4, 5, 8};
    for (size_t i = s->pattern.rows[v]; i < s->pattern.rows[v + 1]; i++) {
        for (int k = 0; k < 6 && s->pattern.columns[i] == v; k++)
            sum->m[k] += s->contacts[9 * i + (size_t)places[k]];
    }
}

static void add_contact_product(const ipc_system *s, const double *x, double *out) {
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        for (size_t i = s->pattern.rows[v]; i < s->pattern.rows[v + 1]; i++) {
            const double *m = s->contacts + 9 * i, *y = x + (size_t)s->pattern.columns[i] * 3;
            for (size_t k = 0; k < 3; k++)
                out[v * 3 + k] += m[3 * k] * y[0] + m[3 * k + 1] * y[1] + m[3 * k + 2] * y[2];
        }
    }
}

void ipc_system_set(ipc_system *s, const double *positions, const cscd_energy_pattern *pattern,
                    const double *contacts) {
    s->pattern = *pattern;
    s->contacts = contacts;
    ipc_springs_hessians(&s->springs, positions, s->hessians);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        double inertia = s->inertia[v];
        s->inverses[v] = (ipc_block){{inertia, 0.0, 0.0, inertia, 0.0, inertia}};
    }
    for (uint32_t i = 0; i < s->springs.count; i++) {
        add_spring(&s->inverses[s->springs.items[i].a], &s->hessians[i]);
        add_spring(&s->inverses[s->springs.items[i].b], &s->hessians[i]);
    }
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        add_contact_block(&s->inverses[v], s, v);
        if (s->inertia[v] > 0.0)
            invert_block(&s->inverses[v]);
        else
            s->inverses[v] = (ipc_block){{0.0}};
    }
}

void ipc_system_product(const ipc_system *s, const double *x, double *out) {
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) out[i] = s->inertia[i / 3] * x[i];
    ipc_springs_add_product(&s->springs, s->hessians, x, out);
    add_contact_product(s, x, out);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (s->inertia[v] == 0.0) memset(out + (size_t)v * 3, 0, 3 * sizeof *out);
    }
}

static double inner_product(const ipc_system *s, const double *a, const double *b) {
    double sum = 0.0;
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) sum += a[i] * b[i];
    return sum;
}

static void add_multiple(const ipc_system *s, double *a, double factor, const double *b) {
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) a[i] += factor * b[i];
}

static void apply_preconditioner(ipc_system *s) {
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const double *m = s->inverses[v].m, *x = s->residual + (size_t)v * 3;
        double *out = s->preconditioned + (size_t)v * 3;
        out[0] = m[0] * x[0] + m[1] * x[1] + m[2] * x[2];
        out[1] = m[1] * x[0] + m[3] * x[1] + m[4] * x[2];
        out[2] = m[2] * x[0] + m[4] * x[1] + m[5] * x[2];
    }
}

uint32_t ipc_system_solve(ipc_system *s, const double *gradient, double tolerance, uint32_t most, double *x) {
    uint32_t count = s->vertex_count * 3, iteration = 0;
    for (uint32_t i = 0; i < count; i++) x[i] = s->inertia[i / 3] > 0.0 ? 0.0 : x[i];
    ipc_system_product(s, x, s->product);
    for (uint32_t i = 0; i < count; i++)
        s->residual[i] = s->inertia[i / 3] > 0.0 ? -gradient[i] - s->product[i] : 0.0;
    apply_preconditioner(s);
    memcpy(s->search, s->preconditioned, count * sizeof *s->search);
    double size = inner_product(s, s->residual, s->preconditioned), enough = tolerance * tolerance * size;
    while (size > enough && iteration < most) {
        ipc_system_product(s, s->search, s->product);
        double length = size / inner_product(s, s->search, s->product), before = size;
        add_multiple(s, x, length, s->search);
        add_multiple(s, s->residual, -length, s->product);
        apply_preconditioner(s);
        size = inner_product(s, s->residual, s->preconditioned);
        for (uint32_t i = 0; i < count; i++)
            s->search[i] = s->preconditioned[i] + size / before * s->search[i];
        iteration++;
    }
    return iteration;
}
