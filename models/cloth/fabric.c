/* Cloth as springs along its edges and stiff hinges across them, by XPBD. */
#include "models/cloth/cloth_scene.h"
#include "models/common/vec3.h"

#include <stdlib.h>

/* An edge of a triangle and the vertex opposite. */
typedef struct side {
    uint32_t low, high, opposite;
} side;

static int compare_sides(const void *left, const void *right) {
    const side *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return (a->opposite > b->opposite) - (a->opposite < b->opposite);
}

/* Returns the sides of all triangles, sorted so that the sides of one edge are neighbours. */
static side *sorted_sides(const body *b) {
    side *sides = body_allocate((size_t)b->triangle_count * 3, sizeof *sides);
    for (uint32_t i = 0; i < b->triangle_count * 3; i++) {
        const uint32_t *v = b->triangles + i / 3 * 3;
        uint32_t from = v[i % 3], to = v[(i + 1) % 3];
        sides[i] = (side){from < to ? from : to, from < to ? to : from, v[(i + 2) % 3]};
    }
    qsort(sides, (size_t)b->triangle_count * 3, sizeof *sides, compare_sides);
    return sides;
}

static double triangle_area(const double *p, const double *q, const double *r) {
    double along[3], across[3], normal[3];
    vec3_subtract(q, p, along);
    vec3_subtract(r, p, across);
    vec3_cross(along, across, normal);
    return 0.5 * vec3_norm(normal);
}

/* Returns the cotangent of the angle at p between q and r. */
static double corner_cotangent(const double *p, const double *q, const double *r) {
    double to_q[3], to_r[3], normal[3];
    vec3_subtract(q, p, to_q);
    vec3_subtract(r, p, to_r);
    vec3_cross(to_q, to_r, normal);
    return vec3_dot(to_q, to_r) / vec3_norm(normal);
}

static double distance_between(const double *p, const double *q) {
    double between[3];
    vec3_subtract(p, q, between);
    return vec3_norm(between);
}

static void weighted_sum(const fabric_hinge *h, const double *positions, double sum[3]) {
    sum[0] = sum[1] = sum[2] = 0.0;
    for (int i = 0; i < 4; i++) vec3_add_scaled(sum, h->weights[i], positions + h->vertices[i] * 3);
}

/* Makes the hinge whose energy is 3 / (2 (A0 + A1)) bending |sum|^2. */
static fabric_hinge make_hinge(const side sides[2], const double *rest, double bending) {
    fabric_hinge h = {.vertices = {sides[0].low, sides[0].high, sides[0].opposite, sides[1].opposite}};
    const double *x[4];
    double sum[3];
    for (int i = 0; i < 4; i++) x[i] = rest + h.vertices[i] * 3;
    double at_0[2] = {corner_cotangent(x[0], x[1], x[2]), corner_cotangent(x[0], x[1], x[3])};
    double at_1[2] = {corner_cotangent(x[1], x[0], x[2]), corner_cotangent(x[1], x[0], x[3])};
    h.weights[0] = at_1[0] + at_1[1];
    h.weights[1] = at_0[0] + at_0[1];
    h.weights[2] = -at_0[0] - at_1[0];
    h.weights[3] = -at_0[1] - at_1[1];
    weighted_sum(&h, rest, sum);
    h.rest = vec3_norm(sum);
    h.compliance = (triangle_area(x[0], x[1], x[2]) + triangle_area(x[0], x[1], x[3])) / (3.0 * bending);
    return h;
}

static double *make_inverse_masses(const body *rest, double density) {
    double *masses = body_allocate(rest->vertex_count, sizeof *masses);
    for (uint32_t t = 0; t < rest->triangle_count; t++) {
        const uint32_t *v = rest->triangles + t * 3;
        double area =
            triangle_area(rest->positions + v[0] * 3, rest->positions + v[1] * 3, rest->positions + v[2] * 3);
        for (int i = 0; i < 3; i++) masses[v[i]] += density * area / 3.0;
    }
    for (uint32_t v = 0; v < rest->vertex_count; v++) masses[v] = 1.0 / masses[v];
    return masses;
}

fabric fabric_make(const body *rest, const fabric_material *m) {
    fabric f = {.vertex_count = rest->vertex_count, .damping = m->damping, .drag = m->drag};
    uint32_t side_count = rest->triangle_count * 3;
    side *sides = sorted_sides(rest);
    f.springs = body_allocate(side_count, sizeof *f.springs);
    f.hinges = body_allocate(side_count, sizeof *f.hinges);
    f.inverse_masses = make_inverse_masses(rest, m->density);
    for (uint32_t i = 0; i < side_count; i++) {
        const side *s = &sides[i];
        if (i > 0 && s->low == sides[i - 1].low && s->high == sides[i - 1].high) {
            f.hinges[f.hinge_count++] = make_hinge(s - 1, rest->positions, m->bending);
            continue;
        }
        double length = distance_between(rest->positions + s->low * 3, rest->positions + s->high * 3);
        f.springs[f.spring_count++] = (fabric_spring){{s->low, s->high}, length, 1.0 / m->stretch};
    }
    free(sides);
    return f;
}

void fabric_free(fabric *f) {
    free(f->springs);
    free(f->hinges);
    free(f->inverse_masses);
    *f = (fabric){0};
}

/* Equation 26 of XPBD for one iteration: the multiplier of a constraint that is off by `error` and has
 * changed by `change` since the small step began. `squares` is the sum of inverse mass * gradient^2. */
static double constraint_multiplier(double error, double change, double squares, double compliance,
                                    double damping, double step) {
    double lag = damping / step;
    return -(error + lag * change) / ((1.0 + lag) * squares + compliance / (step * step));
}

static void solve_spring(const fabric *f, const fabric_spring *s, double step, const double *previous,
                         double *positions) {
    uint32_t a = s->vertices[0] * 3, b = s->vertices[1] * 3;
    double direction[3], before[3];
    vec3_subtract(positions + a, positions + b, direction);
    vec3_subtract(previous + a, previous + b, before);
    double length = vec3_norm(direction);
    if (!vec3_normalize(direction)) return;
    double wa = f->inverse_masses[s->vertices[0]], wb = f->inverse_masses[s->vertices[1]];
    if (wa + wb == 0.0) return;
    double change = constraint_multiplier(length - s->rest, length - vec3_dot(before, direction), wa + wb,
                                          s->compliance, f->damping, step);
    vec3_add_scaled(positions + a, wa * change, direction);
    vec3_add_scaled(positions + b, -wb * change, direction);
}

static void solve_hinge(const fabric *f, const fabric_hinge *h, double step, const double *previous,
                        double *positions) {
    double direction[3], before[3], squares = 0.0;
    weighted_sum(h, positions, direction);
    weighted_sum(h, previous, before);
    for (int i = 0; i < 4; i++) squares += f->inverse_masses[h->vertices[i]] * h->weights[i] * h->weights[i];
    double length = vec3_norm(direction);
    if (squares == 0.0 || !vec3_normalize(direction)) return;
    double change = constraint_multiplier(length - h->rest, length - vec3_dot(before, direction), squares,
                                          h->compliance, f->damping, step);
    for (int i = 0; i < 4; i++)
        vec3_add_scaled(positions + h->vertices[i] * 3,
                        f->inverse_masses[h->vertices[i]] * h->weights[i] * change, direction);
}

void fabric_solve(const fabric *f, double step, const double *previous, double *positions) {
    for (uint32_t i = 0; i < f->spring_count; i++) solve_spring(f, &f->springs[i], step, previous, positions);
    for (uint32_t i = 0; i < f->hinge_count; i++) solve_hinge(f, &f->hinges[i], step, previous, positions);
}

double fabric_energy(const fabric *f, const double *positions, const double *velocities) {
    double energy = 0.0;
    for (uint32_t i = 0; i < f->spring_count; i++) {
        const fabric_spring *s = &f->springs[i];
        double off =
            distance_between(positions + s->vertices[0] * 3, positions + s->vertices[1] * 3) - s->rest;
        energy += 0.5 * off * off / s->compliance;
    }
    for (uint32_t i = 0; i < f->hinge_count; i++) {
        double sum[3];
        weighted_sum(&f->hinges[i], positions, sum);
        double off = vec3_norm(sum) - f->hinges[i].rest;
        energy += 0.5 * off * off / f->hinges[i].compliance;
    }
    for (uint32_t v = 0; v < f->vertex_count; v++) {
        const double *velocity = velocities + v * 3;
        if (f->inverse_masses[v] > 0.0) energy += 0.5 * vec3_dot(velocity, velocity) / f->inverse_masses[v];
    }
    return energy;
}
