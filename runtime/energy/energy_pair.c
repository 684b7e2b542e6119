/* The energy of one pair with its gradient and Hessian, as it is or projected. docs/solver/energies.md derives the formulas.
 *
 * With the energy E of the distance, the weights w of the nearest points, their normal n, tangents t and slides c,
 *
 *     gradient = E' w (x) n
 *     Hessian  = E'' (w (x) n)(w (x) n)^T - E'/d sum over slides (w (x) t + d c (x) n)(...)^T
 *                + E'/d sum over both tangents (w (x) t)(...)^T,
 *
 * where w (x) n has the entries w_i n_k. */
#include "runtime/energy/energy.h"

#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* ---- sums of products of a vector with itself ------------------------------------------------------------- */

/* The lower triangle alone is formed, and then copied. */
static void add_square(double (*hessian)[12], double factor, const double y[12]) {
    for (int i = 0; i < 12; i++) {
        double scaled = factor * y[i];
        for (int j = 0; j <= i; j++) hessian[i][j] += scaled * y[j];
    }
}

static void copy_lower_triangle(double (*hessian)[12]) {
    for (int i = 0; i < 12; i++) {
        for (int j = 0; j < i; j++) hessian[j][i] = hessian[i][j];
    }
}

/* Adds w (x) v to y. */
static void add_outer(const double w[4], const double v[3], double factor, double y[12]) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) y[3 * i + k] += factor * w[i] * v[k];
    }
}

static double dot_of_four(const double a[4], const double b[4]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* ---- the Hessian of a distance's energy ---------------------------------------------------------------- */

/* The pull across a pair, -E'/d; 0 where the normal never turns, and where there is no distance to divide by. */
static double pull_of(const pair_frame *f, const energy_curve *c) {
    return f->straight || f->distance <= 0.0 ? 0.0 : -c->slope / f->distance;
}

static void add_plain_hessian(const pair_frame *f, const energy_curve *c, double (*hessian)[12]) {
    double pull = pull_of(f, c), y[12] = {0.0};
    add_outer(f->weights, f->normal, 1.0, y);
    add_square(hessian, c->curvature, y);
    if (pull == 0.0) return;
    for (int j = 0; j < f->slide_count; j++) {
        memset(y, 0, sizeof y);
        add_outer(f->weights, f->tangents[j], 1.0, y);
        add_outer(f->slides[j], f->normal, f->distance, y);
        add_square(hessian, pull, y);
    }
    for (int j = 0; j < 2; j++) {
        memset(y, 0, sizeof y);
        add_outer(f->weights, f->tangents[j], 1.0, y);
        add_square(hessian, -pull, y);
    }
}

/* ---- its projection -------------------------------------------------------------------------------------- */

/* Orthonormal vectors of weights: the first along the pair's weights, and one more for each slide. */
typedef struct weight_basis {
    double q[3][4];
    int count;
    double length; /* of the weights */
} weight_basis;

static weight_basis make_basis(const pair_frame *f) {
    weight_basis b = {.count = 1, .length = sqrt(dot_of_four(f->weights, f->weights))};
    for (int i = 0; i < 4; i++) b.q[0][i] = f->weights[i] / b.length;
    for (int j = 0; j < f->slide_count; j++) {
        double *q = b.q[b.count];
        memcpy(q, f->slides[j], sizeof b.q[0]);
        for (int again = 0; again < 2; again++) {
            for (int l = 0; l < b.count; l++) {
                double along = dot_of_four(q, b.q[l]);
                for (int i = 0; i < 4; i++) q[i] -= along * b.q[l][i];
            }
        }
        double length = sqrt(dot_of_four(q, q));
        if (length == 0.0) continue;
        for (int i = 0; i < 4; i++) q[i] /= length;
        b.count++;
    }
    return b;
}

/* Writes the Hessian in the basis q (x) n of all q, then q[0] (x) t of the slides' tangents. Across these it is not
 * positive. */
static void write_in_basis(const pair_frame *f, const energy_curve *c, const weight_basis *b,
                           symmetric_matrix *m) {
    double pull = pull_of(f, c);
    m->size = b->count + f->slide_count;
    for (int i = 0; i < m->size; i++) {
        for (int j = 0; j < m->size; j++) m->m[i][j] = 0.0;
    }
    m->m[0][0] = c->curvature * b->length * b->length;
    for (int s = 0; s < f->slide_count; s++) {
        double along[3];
        for (int l = 0; l < b->count; l++) along[l] = f->distance * dot_of_four(f->slides[s], b->q[l]);
        for (int l = 0; l < b->count; l++) {
            m->m[l][b->count + s] = m->m[b->count + s][l] = pull * b->length * along[l];
            for (int k = 0; k < b->count; k++) m->m[l][k] += pull * along[l] * along[k];
        }
    }
}

static void add_projected_hessian(const pair_frame *f, const energy_curve *c, double (*hessian)[12]) {
    if (f->slide_count == 0 || pull_of(f, c) == 0.0) {
        double y[12] = {0.0};
        add_outer(f->weights, f->normal, 1.0, y);
        if (c->curvature > 0.0) add_square(hessian, c->curvature, y);
        return;
    }
    weight_basis b = make_basis(f);
    symmetric_matrix m;
    double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX];
    write_in_basis(f, c, &b, &m);
    symmetric_diagonalize(&m, vectors);
    for (int e = 0; e < m.size; e++) {
        if (!(m.m[e][e] > 0.0)) continue;
        double y[12] = {0.0};
        for (int l = 0; l < b.count; l++) add_outer(b.q[l], f->normal, vectors[l][e], y);
        for (int s = 0; s < f->slide_count; s++)
            add_outer(b.q[0], f->tangents[s], vectors[b.count + s][e], y);
        add_square(hessian, m.m[e][e], y);
    }
}

/* ---- nearly parallel edges ----------------------------------------------------------------------------- */

/* The mollifier of two edges a and b (Li et al. 2020, eq. 24), a function of |a x b|^2, whose derivatives by a and b are
 * `by_a` and `by_b`. */
typedef struct edge_mollifier {
    energy_curve curve;
    double a[3], b[3];
    double gradient[12]; /* of |a x b|^2, by the four vertices */
} edge_mollifier;

static void set_gradient(edge_mollifier *m, const double across[3]) {
    double by_a[3], by_b[3];
    vec3_cross(m->b, across, by_a);
    vec3_cross(across, m->a, by_b);
    for (int k = 0; k < 3; k++) {
        m->gradient[3 + k] = 2.0 * by_a[k];
        m->gradient[k] = -m->gradient[3 + k];
        m->gradient[9 + k] = 2.0 * by_b[k];
        m->gradient[6 + k] = -m->gradient[9 + k];
    }
}

/* False: the mollifier is 1. */
static bool mollifier_find(const cscd_proximity *item, const double *x, edge_mollifier *m) {
    if (item->kind != CSCD_CONTACT_EE || !(item->threshold > 0.0)) return false;
    double across[3];
    vec3_subtract(x + (size_t)item->vertices[1] * 3, x + (size_t)item->vertices[0] * 3, m->a);
    vec3_subtract(x + (size_t)item->vertices[3] * 3, x + (size_t)item->vertices[2] * 3, m->b);
    vec3_cross(m->a, m->b, across);
    double crossing = vec3_dot(across, across), threshold = item->threshold, share = crossing / threshold;
    if (!(crossing < threshold)) return false;
    m->curve =
        (energy_curve){share * (2.0 - share), 2.0 * (1.0 - share) / threshold, -2.0 / threshold / threshold};
    set_gradient(m, across);
    return true;
}

/* Adds the Hessian of |a x b|^2 = |a|^2 |b|^2 - (a . b)^2, times a factor. */
static void add_crossing_hessian(const edge_mollifier *m, double factor, double (*hessian)[12]) {
    const double *a = m->a, *b = m->b, aa = vec3_dot(a, a), bb = vec3_dot(b, b), ab = vec3_dot(a, b);
    double second[6][6]; /* by a and b */
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double same = i == j;
            second[i][j] = 2.0 * (same * bb - b[i] * b[j]);
            second[3 + i][3 + j] = 2.0 * (same * aa - a[i] * a[j]);
            second[i][3 + j] = second[3 + j][i] = 2.0 * (2.0 * a[i] * b[j] - b[i] * a[j] - same * ab);
        }
    }
    for (int i = 0; i < 12; i++) {
        for (int j = 0; j < 12; j++) {
            double sign = (i / 3 % 2 == 0) == (j / 3 % 2 == 0) ? factor : -factor;
            hessian[i][j] += sign * second[i / 6 * 3 + i % 3][j / 6 * 3 + j % 3];
        }
    }
}

/* An orthonormal basis of the weights that add up to 0, of two edges. */
static const double edge_basis[3][4] = {{-0x1.6a09e667f3bcdp-1, 0x1.6a09e667f3bcdp-1, 0.0, 0.0},
                                        {0.0, 0.0, -0x1.6a09e667f3bcdp-1, 0x1.6a09e667f3bcdp-1},
                                        {0.5, 0.5, -0.5, -0.5}};

/* Projects a Hessian that a translation does not change: by its nine other directions. */
static void project_nine(double (*hessian)[12]) {
    symmetric_matrix m = {.size = 9};
    double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX], half[9][12];
    for (int i = 0; i < 9; i++) {
        for (int j = 0; j < 12; j++) {
            half[i][j] = 0.0;
            for (int l = 0; l < 4; l++) half[i][j] += edge_basis[i / 3][l] * hessian[3 * l + i % 3][j];
        }
    }
    for (int i = 0; i < 9; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = 0.0;
            for (int l = 0; l < 4; l++) sum += edge_basis[j / 3][l] * half[i][3 * l + j % 3];
            m.m[i][j] = m.m[j][i] = sum;
        }
    }
    symmetric_diagonalize(&m, vectors);
    memset(hessian, 0, 12 * sizeof *hessian);
    for (int e = 0; e < 9; e++) {
        if (!(m.m[e][e] > 0.0)) continue;
        double y[12] = {0.0};
        for (int i = 0; i < 9; i++) {
            for (int l = 0; l < 4; l++) y[3 * l + i % 3] += vectors[i][e] * edge_basis[i / 3][l];
        }
        add_square(hessian, m.m[e][e], y);
    }
    copy_lower_triangle(hessian);
}

/* Multiplies the energy c and its derivatives, which the term has by now, with the mollifier. */
static void mollify_term(const edge_mollifier *m, const energy_curve *c, const pair_frame *f,
                         energy_term *term) {
    double of_distance[12] = {0.0}; /* the gradient without mollifier */
    add_outer(f->weights, f->normal, c->slope, of_distance);
    if (term->hessian != NULL) {
        for (int i = 0; i < 12; i++) {
            for (int j = 0; j < 12; j++) {
                double mixed = of_distance[i] * m->gradient[j] + m->gradient[i] * of_distance[j];
                term->hessian[i][j] = m->curve.value * term->hessian[i][j] + m->curve.slope * mixed +
                                      c->value * m->curve.curvature * m->gradient[i] * m->gradient[j];
            }
        }
        add_crossing_hessian(m, c->value * m->curve.slope, term->hessian);
        copy_lower_triangle(term->hessian);
        if (term->project) project_nine(term->hessian);
    }
    for (int i = 0; term->gradient != NULL && i < 12; i++)
        term->gradient[i / 3][i % 3] =
            m->curve.value * of_distance[i] + c->value * m->curve.slope * m->gradient[i];
    term->value *= m->curve.value;
}

/* ---- a pair -------------------------------------------------------------------------------------------- */

static energy_curve curve_of_item(const cscd_energy_options *options, const cscd_proximity *item,
                                  const pair_frame *f) {
    energy_curve c = energy_law_at(options, f->distance, energy_separation_of(item));
    double factor = options->stiffness * energy_weight_of(item);
    if (c.value == INFINITY || factor == 0.0) return (energy_curve){factor > 0.0 ? INFINITY : 0.0, 0.0, 0.0};
    return (energy_curve){factor * c.value, factor * c.slope, factor * c.curvature};
}

static void clear_derivatives(energy_term *term) {
    if (term->gradient != NULL) memset(term->gradient, 0, 4 * sizeof *term->gradient);
    if (term->hessian != NULL) memset(term->hessian, 0, 12 * sizeof *term->hessian);
}

void energy_pair_evaluate(const cscd_energy_options *options, const cscd_proximity *item, const double *x,
                          energy_term *term) {
    pair_frame f;
    edge_mollifier m;
    pair_frame_find(item, x, &f);
    energy_curve c = curve_of_item(options, item, &f);
    term->gap = f.distance - energy_separation_of(item);
    term->value = c.value;
    clear_derivatives(term);
    if (c.value == 0.0 || c.value == INFINITY) return;
    bool mollified = mollifier_find(item, x, &m);
    if (term->gradient != NULL) add_outer(f.weights, f.normal, c.slope, term->gradient[0]);
    if (term->hessian != NULL) {
        if (term->project && !mollified)
            add_projected_hessian(&f, &c, term->hessian);
        else
            add_plain_hessian(&f, &c, term->hessian);
        copy_lower_triangle(term->hessian);
    }
    if (mollified) mollify_term(&m, &c, &f, term);
}

double energy_pair_force(const cscd_energy_options *options, const cscd_proximity *item, const double *x,
                         pair_frame *frame) {
    edge_mollifier m;
    pair_frame_find(item, x, frame);
    energy_curve c = curve_of_item(options, item, frame);
    if (c.value == INFINITY) return INFINITY;
    return -c.slope * (mollifier_find(item, x, &m) ? m.curve.value : 1.0);
}
