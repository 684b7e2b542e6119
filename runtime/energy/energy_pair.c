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

/* ---- Hessians of a distance's energy ------------------------------------------------------------------- */

/* Adds w (x) v to y. */
static void add_outer(const double w[4], const double v[3], double factor, double y[12]) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) y[3 * i + k] += factor * w[i] * v[k];
    }
}

static double dot_of_four(const double a[4], const double b[4]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* A Hessian by the directions of a pair's frame: the block of the vertices i and j is
 *
 *     along_ij n n^T + sum over tangents t_a of (mixed_ia w_j n t_a^T + mixed_ja w_i t_a n^T)
 *     + w_i w_j sum of across_ab t_a t_b^T. */
typedef struct frame_hessian {
    double along[4][4], mixed[4][2], across[2][2];
} frame_hessian;

/* The pull across a pair, -E'/d; 0 where the normal never turns, and where there is no distance to divide by. */
static double pull_of(const pair_frame *f, const energy_curve *c) {
    return f->straight || f->distance <= 0.0 ? 0.0 : -c->slope / f->distance;
}

static void set_frame_hessian(const pair_frame *f, const energy_curve *c, double pull, frame_hessian *h) {
    memset(h, 0, sizeof *h);
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) h->along[i][j] = c->curvature * f->weights[i] * f->weights[j];
    }
    for (int s = 0; s < f->slide_count; s++) {
        double step[4];
        for (int i = 0; i < 4; i++) step[i] = f->distance * f->slides[s][i];
        for (int i = 0; i < 4; i++) {
            h->mixed[i][s] = pull * step[i];
            for (int j = 0; j < 4; j++) h->along[i][j] += pull * step[i] * step[j];
        }
    }
    for (int s = f->slide_count; s < 2; s++) h->across[s][s] = -pull;
}

/* Subtracts value * y y^T with y = p (x) n + w (x) (t's times r). */
static void take_off_square(frame_hessian *h, double value, const double p[4], const double r[2]) {
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) h->along[i][j] -= value * p[i] * p[j];
        for (int a = 0; a < 2; a++) h->mixed[i][a] -= value * p[i] * r[a];
    }
    for (int a = 0; a < 2; a++) {
        for (int b = 0; b < 2; b++) h->across[a][b] -= value * r[a] * r[b];
    }
}

static void copy_lower_triangle(double (*hessian)[12]) {
    for (int i = 0; i < 12; i++) {
        for (int j = 0; j < i; j++) hessian[j][i] = hessian[i][j];
    }
}

/* Writes all twelve rows. */
static void expand_hessian(const pair_frame *f, const frame_hessian *h, double (*hessian)[12]) {
    const double *n = f->normal, *w = f->weights;
    double mixed[4][3], across[3][3];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 4; i++)
            mixed[i][k] = h->mixed[i][0] * f->tangents[0][k] + h->mixed[i][1] * f->tangents[1][k];
        double first = h->across[0][0] * f->tangents[0][k] + h->across[1][0] * f->tangents[1][k];
        double second = h->across[0][1] * f->tangents[0][k] + h->across[1][1] * f->tangents[1][k];
        for (int l = 0; l < 3; l++) across[k][l] = first * f->tangents[0][l] + second * f->tangents[1][l];
    }
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j <= i; j++) {
            double right[3], both = w[i] * w[j];
            for (int l = 0; l < 3; l++) right[l] = h->along[i][j] * n[l] + w[j] * mixed[i][l];
            for (int k = 0; k < 3; k++) {
                double left = w[i] * mixed[j][k];
                for (int l = 0; l < 3; l++)
                    hessian[3 * i + k][3 * j + l] = n[k] * right[l] + left * n[l] + both * across[k][l];
            }
        }
    }
    copy_lower_triangle(hessian);
}

/* ---- their projection ------------------------------------------------------------------------------------ */

/* Turns the slides so that they are orthogonal to each other, and gives their lengths times d. A slide of no length goes away. */
static void turn_slides(const pair_frame *f, double slides[2][4], double turned[2][2], double lengths[2],
                        int *count) {
    double c = 1.0, s = 0.0;
    if (f->slide_count == 2) {
        double aa = dot_of_four(f->slides[0], f->slides[0]), bb = dot_of_four(f->slides[1], f->slides[1]);
        double ab = dot_of_four(f->slides[0], f->slides[1]), difference = bb - aa;
        double root = fabs(difference) + sqrt(difference * difference + 4.0 * ab * ab);
        double tangent = ab == 0.0 ? 0.0 : (difference < 0.0 ? -2.0 : 2.0) * ab / root;
        c = 1.0 / sqrt(1.0 + tangent * tangent);
        s = tangent * c;
    }
    const double turns[2][2] = {{c, -s}, {s, c}};
    *count = 0;
    for (int j = 0; j < f->slide_count; j++) {
        double *slide = slides[*count];
        for (int i = 0; i < 4; i++) slide[i] = f->slides[0][i] * turns[j][0];
        for (int i = 0; i < 4 && f->slide_count == 2; i++) slide[i] += f->slides[1][i] * turns[j][1];
        double length = sqrt(dot_of_four(slide, slide));
        if (!(length > 0.0)) continue;
        for (int i = 0; i < 4; i++) slide[i] /= length;
        memcpy(turned[*count], turns[j], sizeof turns[j]);
        lengths[(*count)++] = f->distance * length;
    }
}

/* Takes the negative eigenvalues off. With orthogonal slides u of the lengths s, the Hessian is pull * ((s^2, |w| s), (|w| s, 0)) in
 * the plane of u (x) n and w (x) t / |w|, for each slide, plus the square E'' (w (x) n)(...)^T: diagonal in the eigenvectors of these
 * planes, and one square. The tangents along which nothing slides are negative alone, and have been left out. */
static void project_frame_hessian(const pair_frame *f, const energy_curve *c, double pull, frame_hessian *h) {
    double slides[2][4], turned[2][2], lengths[2], cosines[2], sines[2], whole[4];
    double size = sqrt(dot_of_four(f->weights, f->weights));
    int count;
    turn_slides(f, slides, turned, lengths, &count);
    diagonal_and_square m = {.size = 2 * count + 1, .factor = max_of(c->curvature, 0.0) * size * size};
    for (int i = 0; i < 4; i++) whole[i] = f->weights[i] / size;
    double rest[4];
    memcpy(rest, whole, sizeof rest);
    for (int j = 0; j < count; j++) {
        double part = dot_of_four(whole, slides[j]);
        double ratio = 2.0 * size / (lengths[j] + sqrt(lengths[j] * lengths[j] + 4.0 * size * size));
        cosines[j] = 1.0 / sqrt(1.0 + ratio * ratio);
        sines[j] = ratio * cosines[j];
        for (int i = 0; i < 4; i++) rest[i] -= part * slides[j][i];
        m.diagonal[2 * j] = -pull * lengths[j] * size * ratio;
        m.vector[2 * j] = -part * sines[j];
        m.diagonal[2 * j + 1] = pull * lengths[j] * size / ratio;
        m.vector[2 * j + 1] = part * cosines[j];
    }
    double left = sqrt(dot_of_four(rest, rest));
    m.diagonal[2 * count] = 0.0;
    m.vector[2 * count] = left;
    double values[2], vectors[2][SQUARE_MAX];
    int negative = diagonal_and_square_negative(&m, values, vectors);
    for (int e = 0; e < negative; e++) {
        double p[4], r[2] = {0.0, 0.0};
        for (int i = 0; i < 4; i++) p[i] = left > 0.0 ? vectors[e][2 * count] * rest[i] / left : 0.0;
        for (int j = 0; j < count; j++) {
            double low = vectors[e][2 * j], high = vectors[e][2 * j + 1];
            for (int i = 0; i < 4; i++) p[i] += (high * cosines[j] - low * sines[j]) * slides[j][i];
            for (int a = 0; a < 2; a++) r[a] += (high * sines[j] + low * cosines[j]) * turned[j][a] / size;
        }
        take_off_square(h, values[e], p, r);
    }
}

static void write_hessian(const pair_frame *f, const energy_curve *c, bool project, double (*hessian)[12]) {
    frame_hessian h;
    double pull = pull_of(f, c);
    set_frame_hessian(f, c, pull, &h);
    if (project) {
        for (int s = f->slide_count; s < 2; s++) h.across[s][s] = 0.0;
        if (f->slide_count > 0 && pull > 0.0) project_frame_hessian(f, c, pull, &h);
    }
    expand_hessian(f, &h, hessian);
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
            for (int l = 0; l < 4; l++) y[3 * l + i % 3] += vectors[e][i] * edge_basis[i / 3][l];
        }
        for (int i = 0; i < 12; i++) {
            for (int j = 0; j <= i; j++) hessian[i][j] += m.m[e][e] * y[i] * y[j];
        }
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
    energy_curve c = energy_law_at(options, f->distance, energy_separation_of(options, item));
    double factor = options->stiffness * energy_weight_of(options, item);
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
    term->gap = f.distance - energy_separation_of(options, item);
    term->value = c.value;
    clear_derivatives(term);
    if (c.value == 0.0 || c.value == INFINITY) return;
    bool mollified = mollifier_find(item, x, &m);
    if (term->gradient != NULL) add_outer(f.weights, f.normal, c.slope, term->gradient[0]);
    if (term->hessian != NULL) write_hessian(&f, &c, term->project && !mollified, term->hessian);
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
