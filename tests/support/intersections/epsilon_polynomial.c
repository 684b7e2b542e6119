/* Polynomials in an infinitely small epsilon with integer coefficients: the moved coordinates of docs/theory/curves.md,
 * written out. */
#include "tests/support/intersections/epsilon_polynomial.h"

#include <assert.h>
#include <stdlib.h>

static void add_term(epsilon_polynomial *p, uint64_t power, int64_t coefficient) {
    int i = 0;
    while (i < p->count && p->terms[i].power < power) i++;
    if (i < p->count && p->terms[i].power == power) {
        p->terms[i].coefficient += coefficient;
        if (p->terms[i].coefficient != 0) return;
        for (p->count--; i < p->count; i++) p->terms[i] = p->terms[i + 1];
        return;
    }
    if (coefficient == 0) return;
    assert(p->count < EPSILON_TERMS);
    for (int j = p->count++; j > i; j--) p->terms[j] = p->terms[j - 1];
    p->terms[i].power = power;
    p->terms[i].coefficient = coefficient;
}

void epsilon_add(epsilon_polynomial *sum, const epsilon_polynomial *p, int factor, uint64_t power) {
    for (int i = 0; i < p->count; i++)
        add_term(sum, p->terms[i].power + power, factor * p->terms[i].coefficient);
}

static void multiply_polynomials(const epsilon_polynomial *a, const epsilon_polynomial *b,
                                 epsilon_polynomial *out) {
    out->count = 0;
    for (int i = 0; i < a->count; i++) {
        for (int j = 0; j < b->count; j++)
            add_term(out, a->terms[i].power + b->terms[j].power,
                     a->terms[i].coefficient * b->terms[j].coefficient);
    }
}

void epsilon_move(grid_point p, epsilon_point *out) {
    assert(p.name < EPSILON_NAMES);
    for (uint32_t k = 0; k < 3; k++) {
        out->x[k].count = 0;
        add_term(&out->x[k], 0, p.x[k]);
        add_term(&out->x[k], UINT64_C(1) << (3 * p.name + k), 1);
    }
}

/* to - from in one coordinate. */
static void subtract_coordinates(const epsilon_point *from, const epsilon_point *to, int k,
                                 epsilon_polynomial *out) {
    out->count = 0;
    epsilon_add(out, &to->x[k], 1, 0);
    epsilon_add(out, &from->x[k], -1, 0);
}

void epsilon_orient_along(const epsilon_point *const p[3], int axis, epsilon_polynomial *out) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    epsilon_polynomial u, v, product;
    subtract_coordinates(p[0], p[1], x, &u);
    subtract_coordinates(p[0], p[2], y, &v);
    multiply_polynomials(&u, &v, out);
    subtract_coordinates(p[0], p[1], y, &u);
    subtract_coordinates(p[0], p[2], x, &v);
    multiply_polynomials(&u, &v, &product);
    epsilon_add(out, &product, -1, 0);
}

void epsilon_orient3d(const epsilon_point *const p[4], epsilon_polynomial *out) {
    epsilon_polynomial turn, along, part;
    out->count = 0;
    for (int axis = 0; axis < 3; axis++) {
        epsilon_orient_along(p, axis, &turn);
        subtract_coordinates(p[0], p[3], axis, &along);
        multiply_polynomials(&turn, &along, &part);
        epsilon_add(out, &part, 1, 0);
    }
}

void grid_orient3d(const grid_point p[4], epsilon_polynomial *out) {
    epsilon_point points[4];
    for (int i = 0; i < 4; i++) epsilon_move(p[i], &points[i]);
    epsilon_orient3d((const epsilon_point *const[4]){&points[0], &points[1], &points[2], &points[3]}, out);
}

void grid_orient_along(const grid_point p[3], int axis, epsilon_polynomial *out) {
    epsilon_point points[3];
    for (int i = 0; i < 3; i++) epsilon_move(p[i], &points[i]);
    epsilon_orient_along((const epsilon_point *const[3]){&points[0], &points[1], &points[2]}, axis, out);
}

int epsilon_sign(const epsilon_polynomial *p) {
    if (p->count == 0) return 0;
    return p->terms[0].coefficient > 0 ? 1 : -1;
}
