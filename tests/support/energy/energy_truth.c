/* The energy of one pair by the formulas of Li et al. 2020, in long doubles, and its derivatives by differences. */
#include "tests/support/energy/energy_truth.h"

#include <math.h>
#include <string.h>

typedef long double wide;

/* ---- distances by formulas ------------------------------------------------------------------------------- */

static void wide_difference(const wide *a, const wide *b, wide out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

static wide wide_dot(const wide *a, const wide *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void wide_cross(const wide *a, const wide *b, wide out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static wide point_point(const wide *p, const wide *q) {
    wide d[3];
    wide_difference(p, q, d);
    return sqrtl(wide_dot(d, d));
}

static wide point_line(const wide *p, const wide *a, const wide *b) {
    wide along[3], from[3], across[3];
    wide_difference(b, a, along);
    wide_difference(p, a, from);
    wide_cross(along, from, across);
    return sqrtl(wide_dot(across, across) / wide_dot(along, along));
}

static wide along_normal(const wide *from, const wide *s, const wide *t) {
    wide normal[3];
    wide_cross(s, t, normal);
    return fabsl(wide_dot(from, normal)) / sqrtl(wide_dot(normal, normal));
}

static wide point_plane(const wide *x) {
    wide s[3], t[3], from[3];
    wide_difference(x + 6, x + 3, s);
    wide_difference(x + 9, x + 3, t);
    wide_difference(x, x + 3, from);
    return along_normal(from, s, t);
}

static wide line_line(const wide *x) {
    wide s[3], t[3], from[3];
    wide_difference(x + 3, x, s);
    wide_difference(x + 9, x + 6, t);
    wide_difference(x, x + 6, from);
    return along_normal(from, s, t);
}

static wide face_distance(const energy_case *p, const wide *x) {
    int on[3], count = 0;
    if (p->u + p->v < 1.0) on[count++] = 1;
    if (p->u > 0.0) on[count++] = 2;
    if (p->v > 0.0) on[count++] = 3;
    if (count == 1) return point_point(x, x + (ptrdiff_t)3 * on[0]);
    if (count == 2) return point_line(x, x + (ptrdiff_t)3 * on[0], x + (ptrdiff_t)3 * on[1]);
    return point_plane(x);
}

static wide edge_distance(const energy_case *p, const wide *x) {
    bool end_a = p->u == 0.0 || p->u == 1.0, end_b = p->v == 0.0 || p->v == 1.0;
    const wide *a = x + (p->u == 1.0 ? 3 : 0), *b = x + (p->v == 1.0 ? 9 : 6);
    if (p->item.kind == CSCD_CONTACT_EV) return end_a ? point_point(a, x + 6) : point_line(x + 6, x, x + 3);
    if (end_a && end_b) return point_point(a, b);
    if (end_a) return point_line(a, x + 6, x + 9);
    return end_b ? point_line(b, x, x + 3) : line_line(x);
}

static wide distance_of(const energy_case *c, const wide *x) {
    const cscd_proximity *p = &c->item;
    if (p->kind == CSCD_CONTACT_VF) return face_distance(c, x);
    if (p->kind == CSCD_CONTACT_VV) return point_point(x, x + 3);
    if (p->kind != CSCD_CONTACT_VH) return edge_distance(c, x);
    wide apart[3], normal[3] = {p->normal[0], p->normal[1], p->normal[2]};
    wide_difference(x, x + 3, apart);
    return wide_dot(apart, normal);
}

/* ---- laws and mollifier ---------------------------------------------------------------------------------- */

static wide barrier_of(wide x, wide r) {
    return x >= r ? 0.0L : -(x - r) * (x - r) * logl(x / r);
}

static wide law_of(const cscd_energy_options *o, wide d, wide s) {
    wide r = o->reach, factor = o->physical ? 1.0L / r : 1.0L, square = (s + r) * (s + r) - s * s;
    if (d >= s + r) return 0.0L;
    if (o->law == CSCD_ENERGY_BARRIER) return factor * barrier_of(d - s, r);
    if (o->law == CSCD_ENERGY_QUADRATIC) return factor * (r - d + s) * (r - d + s) / 2.0L;
    if (o->law == CSCD_ENERGY_CUBIC) return factor * powl(r - d + s, 3.0L) / (6.0L * r);
    return (o->physical ? r / (square * square) : 1.0L) * barrier_of(d * d - s * s, square);
}

static wide mollifier_at(const cscd_proximity *p, const wide *x) {
    wide a[3], b[3], across[3];
    if (p->kind != CSCD_CONTACT_EE || p->threshold == 0.0) return 1.0L;
    wide_difference(x + 3, x, a);
    wide_difference(x + 9, x + 6, b);
    wide_cross(a, b, across);
    wide share = wide_dot(across, across) / p->threshold;
    return share < 1.0L ? share * (2.0L - share) : 1.0L;
}

long double energy_truth(const energy_case *c, const long double x[12]) {
    wide factor = (wide)c->options.stiffness * CASE_WEIGHT(c);
    return factor * mollifier_at(&c->item, x) * law_of(&c->options, distance_of(c, x), CASE_SEPARATION(c));
}

/* ---- derivatives ----------------------------------------------------------------------------------------- */

static wide energy_moved(const energy_case *c, int i, wide by_i, int j, wide by_j) {
    wide x[12];
    for (int k = 0; k < 12; k++) x[k] = c->x[k];
    x[i] += by_i;
    x[j] += by_j;
    return energy_truth(c, x);
}

static wide slope_by(const energy_case *c, int i, wide h) {
    return (energy_moved(c, i, h, i, 0.0L) - energy_moved(c, i, -h, i, 0.0L)) / (2.0L * h);
}

static wide curvature_by(const energy_case *c, int i, int j, wide h) {
    return (energy_moved(c, i, h, j, h) - energy_moved(c, i, h, j, -h) - energy_moved(c, i, -h, j, h) +
            energy_moved(c, i, -h, j, -h)) /
           (4.0L * h * h);
}

enum { LEVELS = 4 };

/* Richardson's extrapolation of differences whose errors are even powers of the step. */
static wide extrapolate_levels(wide d[LEVELS]) {
    for (int order = 1; order < LEVELS; order++) {
        wide factor = powl(4.0L, order);
        for (int i = 0; i + order < LEVELS; i++) d[i] = (factor * d[i + 1] - d[i]) / (factor - 1.0L);
    }
    return d[0];
}

void energy_truth_derivatives(const energy_case *c, long double step, long double gradient[12],
                              long double hessian[12][12]) {
    wide d[LEVELS];
    for (int i = 0; i < 12; i++) {
        for (int l = 0; l < LEVELS; l++) d[l] = slope_by(c, i, step / powl(2.0L, l));
        gradient[i] = extrapolate_levels(d);
        for (int j = 0; j <= i; j++) {
            for (int l = 0; l < LEVELS; l++) d[l] = curvature_by(c, i, j, step / powl(2.0L, l));
            hessian[i][j] = hessian[j][i] = extrapolate_levels(d);
        }
    }
}

/* ---- projection -------------------------------------------------------------------------------------------- */

static void rotate_plainly(wide a[12][12], wide v[12][12], int p, int q) {
    wide angle = 0.5L * atan2l(2.0L * a[p][q], a[q][q] - a[p][p]), c = cosl(angle), s = sinl(angle);
    for (int i = 0; i < 12; i++) {
        wide ap = a[i][p], aq = a[i][q], vp = v[i][p], vq = v[i][q];
        a[i][p] = c * ap - s * aq, a[i][q] = s * ap + c * aq;
        v[i][p] = c * vp - s * vq, v[i][q] = s * vp + c * vq;
    }
    for (int i = 0; i < 12; i++) {
        wide ap = a[p][i], aq = a[q][i];
        a[p][i] = c * ap - s * aq, a[q][i] = s * ap + c * aq;
    }
}

void project_plainly(const double hessian[12][12], long double out[12][12]) {
    wide a[12][12], v[12][12] = {{0.0L}};
    for (int i = 0; i < 144; i++) a[i / 12][i % 12] = hessian[i / 12][i % 12];
    for (int i = 0; i < 12; i++) v[i][i] = 1.0L;
    for (int sweep = 0; sweep < 12; sweep++) {
        for (int p = 0; p < 12; p++) {
            for (int q = p + 1; q < 12; q++) rotate_plainly(a, v, p, q);
        }
    }
    for (int i = 0; i < 144; i++) {
        out[i / 12][i % 12] = 0.0L;
        for (int e = 0; e < 12; e++)
            out[i / 12][i % 12] += fmaxl(a[e][e], 0.0L) * v[i / 12][e] * v[i % 12][e];
    }
}

/* ---- cases ----------------------------------------------------------------------------------------------- */

static double random_side(random_stream *random) {
    return stream_between(random, -1.0, 1.0);
}

/* The border of a feature at which the nearest point is. */
static void set_border(random_stream *random, pair_shape shape, energy_case *p) {
    uint32_t which = stream_below(random, 4);
    double inner = stream_between(random, 0.2, 0.8);
    static const double corners[3][2] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
    p->u = stream_between(random, 0.2, 0.4), p->v = stream_between(random, 0.2, 0.4);
    if (shape == SHAPE_VF_CORNER) p->u = corners[which % 3][0], p->v = corners[which % 3][1];
    if (shape == SHAPE_VF_EDGE) {
        p->u = which % 3 == 0 ? 0.0 : which % 3 == 1 ? inner : 0.75;
        p->v = which % 3 == 0 ? inner : which % 3 == 1 ? 0.0 : 0.25;
    }
    if (shape == SHAPE_EE_END && which < 2) p->u = which;
    if (shape == SHAPE_EE_END && which >= 2) p->v = which - 2;
    if (shape == SHAPE_EE_ENDS) p->u = which % 2, p->v = which / 2;
    if (shape == SHAPE_EV_END) p->u = which % 2;
    if (shape == SHAPE_VV || shape == SHAPE_VH) p->u = 0.0;
    if (shape >= SHAPE_EV) p->v = 0.0;
}

static cscd_contact_kind kind_of_shape(pair_shape shape) {
    static const cscd_contact_kind kinds[SHAPE_COUNT] = {
        CSCD_CONTACT_VF, CSCD_CONTACT_VF, CSCD_CONTACT_VF, CSCD_CONTACT_EE, CSCD_CONTACT_EE,
        CSCD_CONTACT_EE, CSCD_CONTACT_EV, CSCD_CONTACT_EV, CSCD_CONTACT_VV, CSCD_CONTACT_VH};
    return kinds[shape];
}

/* Moves the first feature so that its nearest point lies `distance` along a normal from that of the second one; on the border of
 * a feature the lines to the point need not be across it. */
static void place_first(energy_case *c, double distance, const double normal[3]) {
    const double *weights = c->item.weights;
    for (int k = 0; k < 3; k++) {
        double apart = 0.0;
        for (int i = 0; i < 4; i++) apart += weights[i] * c->x[3 * i + k];
        int first = c->item.kind == CSCD_CONTACT_EE || c->item.kind == CSCD_CONTACT_EV ? 2 : 1;
        for (int i = 0; i < first; i++) c->x[3 * i + k] += distance * normal[k] - apart;
    }
}

/* A direction across those in which points slide. */
static void normal_of_case(const energy_case *c, random_stream *random, double out[3]) {
    const cscd_proximity *p = &c->item;
    double slides[2][3] = {{0.0}}, length = 0.0;
    for (int k = 0; k < 3; k++) out[k] = random_side(random);
    int from[2] = {0, 2}, to[2] = {1, 3};
    bool used[2] = {p->kind == CSCD_CONTACT_EE || p->kind == CSCD_CONTACT_EV, p->kind == CSCD_CONTACT_EE};
    used[0] = used[0] && c->u != 0.0 && c->u != 1.0;
    used[1] = used[1] && c->v != 0.0 && c->v != 1.0;
    if (p->kind == CSCD_CONTACT_VF) {
        int on[3], count = 0;
        if (c->u + c->v < 1.0) on[count++] = 1;
        if (c->u > 0.0) on[count++] = 2;
        if (c->v > 0.0) on[count++] = 3;
        used[0] = count > 1, used[1] = count > 2;
        for (int i = 1; i < count; i++) from[i - 1] = on[0], to[i - 1] = on[i];
    }
    for (int j = 0; j < 2; j++) {
        if (!used[j]) continue;
        double square = 0.0, along = 0.0, mixed = 0.0;
        for (int k = 0; k < 3; k++) {
            slides[j][k] = c->x[3 * to[j] + k] - c->x[3 * from[j] + k];
            mixed += j == 1 && used[0] ? slides[1][k] * slides[0][k] : 0.0;
        }
        for (int k = 0; k < 3; k++) slides[j][k] -= j == 1 ? mixed * slides[0][k] : 0.0;
        for (int k = 0; k < 3; k++) square += slides[j][k] * slides[j][k];
        for (int k = 0; k < 3; k++) slides[j][k] /= sqrt(square);
        for (int k = 0; k < 3; k++) along += slides[j][k] * out[k];
        for (int k = 0; k < 3; k++) out[k] -= along * slides[j][k];
    }
    for (int k = 0; k < 3; k++) length += out[k] * out[k];
    for (int k = 0; k < 3; k++) out[k] /= sqrt(length);
}

energy_case energy_case_make(random_stream *random, pair_shape shape, double distance) {
    energy_case c;
    memset(&c, 0, sizeof c);
    c.options = cscd_energy_defaults();
    c.item.kind = kind_of_shape(shape);
    c.item.count = 1 + stream_below(random, 5);
    c.item.weight = stream_between(random, 0.1, 2.0);
    for (uint32_t i = 0; i < 4; i++) c.item.vertices[i] = i;
    for (int i = 0; i < 12; i++) c.x[i] = random_side(random);
    set_border(random, shape, &c);
    cscd_stencil_weights(c.item.kind, c.u, c.v, c.item.weights);
    double normal[3];
    normal_of_case(&c, random, normal);
    place_first(&c, distance, normal);
    memcpy(c.item.normal, normal, sizeof normal);
    if (shape == SHAPE_EV || shape == SHAPE_EV_END)
        memcpy(c.x + 9, c.x + 6, 3 * sizeof *c.x), c.item.vertices[3] = 2;
    if (shape == SHAPE_VV || shape == SHAPE_VH) c.item.vertices[2] = c.item.vertices[3] = 1;
    return c;
}
